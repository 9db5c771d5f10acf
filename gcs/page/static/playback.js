// A flight inside a report: the scene of the live page, fed from rows of places, with the replay's own timeline.
import { colours } from "colours";
import { Scene } from "scene";
import { Timeline } from "timeline";

const STEPS = { on: 10000, back: -10000, step: 100, step_back: -100 };
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10, 30];
const ROLES = ["", "evader", "pursuer", "tracker"];

// Place and way at a time, between two rows of [t, north, east, down]; null outside.
export function between(rows, t) {
  let [low, high] = [0, rows.length - 1];
  if (high < 1 || t < rows[0][0] || t > rows[high][0]) return null;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (rows[middle][0] <= t) low = middle;
    else high = middle;
  }
  const [a, b] = [rows[low], rows[high]];
  const span = Math.max(b[0] - a[0], 1e-9);
  const share = (t - a[0]) / span;
  const at = [1, 2, 3].map((i) => a[i] + share * (b[i] - a[i]));
  const way = [1, 2, 3].map((i) => (b[i] - a[i]) / span);
  return { at, way };
}

export class Playback {
  // `data`: {palette, field, ways: [{id, role, rows}], marks, begin, end} in seconds since t₀; `told(t)` each move.
  constructor(host, time, data, told) {
    this.data = data;
    this.told = told;
    this.t = Math.max(0, data.begin);
    this.speed = 1;
    this.playing = false;
    this.loops = false;
    this.scene = new Scene(host, {});
    this.timeline = new Timeline(time, (message) => this.take(message));
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.dark.addEventListener("change", () => this.theme());
    this.theme();
    this.scene.setField(data.field);
    this.timeline.setMarks({ marks: data.marks, zero_ms: -1000 * data.begin, curves: [] });
    this.move(this.t);
    let then = performance.now();
    const run = (now) => {
      requestAnimationFrame(run);
      if (this.playing) this.advance((now - then) / 1000);
      then = now;
    };
    requestAnimationFrame(run);
  }

  theme() {
    const found = colours(this.data.palette, this.dark.matches);
    this.scene.setColours(found);
    this.timeline.setColours(found);
  }

  advance(seconds) {
    let t = this.t + seconds * this.speed;
    if (t >= this.data.end) {
      t = this.loops ? this.data.begin : this.data.end;
      this.playing = this.loops;
    }
    this.move(t);
  }

  take(message) {
    if (message.do === "seek") this.move(this.data.begin + message.at_ms / 1000);
    else this.act(message.action);
  }

  act(action) {
    const [verb, value] = action.split(" ");
    if (verb === "pause") {
      this.playing = !this.playing;
      if (this.playing && this.t >= this.data.end) this.t = this.data.begin;
    } else if (STEPS[verb]) {
      if (verb.startsWith("step")) this.playing = false;
      this.move(this.t + STEPS[verb] / 1000);
    } else if (verb === "loop") this.loops = !this.loops;
    else if (verb === "speed") this.speed = Number(value);
    else if (verb === "start") this.move(this.data.begin);
    else if (verb === "end") this.move(this.data.end);
    else if (verb === "faster" || verb === "slower") {
      const at = SPEEDS.indexOf(this.speed) + (verb === "faster" ? 1 : -1);
      this.speed = SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, at))];
    }
    this.show();
  }

  show() {
    const { begin, end } = this.data;
    this.timeline.show({
      at_ms: Math.round(1000 * (this.t - begin)), length_ms: Math.round(1000 * (end - begin)),
      playing: this.playing, speed: this.speed, loops: this.loops,
    });
  }

  // Show this instant [s since t₀].
  move(t) {
    const back = t < this.t || t > this.t + 5;
    this.t = Math.max(this.data.begin, Math.min(this.data.end, t));
    if (back) this.trails();
    const vehicles = [];
    for (const { id, role, rows } of this.data.ways) {
      const found = between(rows, this.t) || between(rows, Math.max(rows[0][0], Math.min(rows[rows.length - 1][0], this.t)));
      if (!found) continue;
      const { at: [north, east, down], way: [n, e, d] } = found;
      vehicles.push({
        id, role: ROLES.indexOf(role), grade: 4, fed: this.t >= rows[0][0] && this.t <= rows[rows.length - 1][0],
        x: east, y: -down, z: -north, vx: e, vy: -d, vz: -n,
        roll: 0, pitch: Math.atan2(-d, Math.hypot(n, e) || 1e-9), yaw: Math.atan2(e, n),
      });
    }
    this.scene.setFrame({ ms: 1000 * this.t, vehicles, tracks: [] }, ROLES);
    this.show();
    if (this.told) this.told(this.t);
  }

  trails() {
    const vehicles = {};
    for (const { id, rows } of this.data.ways) {
      vehicles[id] = rows.filter((row) => row[0] <= this.t).map((row) => row.slice(1));
    }
    this.scene.setTrails({ vehicles, tracks: {} });
  }
}

window.Playback = Playback;
