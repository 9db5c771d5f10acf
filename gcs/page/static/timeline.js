// The time of a replay: a slider with marks, pause, speed, steps and a loop, and curves under one cursor.
import { Curves } from "curves";

const KEYS = { " ": "pause", ArrowRight: "on", ArrowLeft: "back", ".": "step", ",": "step_back", "+": "faster", "-": "slower", Home: "start", End: "end" };
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10, 30];
const NEXT_MS = 50; // a mark so near is where one is
const SEEK_EACH_MS = 60; // while the slider is dragged

export function minutes(ms) {
  const seconds = ms / 1000;
  return `${Math.floor(seconds / 60)}:${(seconds % 60).toFixed(1).padStart(4, "0")}`;
}

function element(tag, text = "", className = "") {
  const found = document.createElement(tag);
  found.textContent = text;
  if (className) found.className = className;
  return found;
}

export class Timeline {
  // `send(message)` goes to the server: {do: "seek", at_ms} or {do: "act", action}.
  constructor(host, send) {
    this.host = host;
    this.send = send;
    this.state = null;
    this.marks = null;
    this.sent = 0;
  }

  build() {
    this.play = element("button", "▶");
    this.play.addEventListener("click", () => this.act("pause"));
    this.back = element("button", "−0.1 s");
    this.back.addEventListener("click", () => this.act("step_back"));
    this.on = element("button", "+0.1 s");
    this.on.addEventListener("click", () => this.act("step"));
    this.loop = element("button", "loop");
    this.loop.addEventListener("click", () => this.act("loop"));
    this.speed = document.createElement("select");
    this.speed.setAttribute("aria-label", "speed");
    for (const value of SPEEDS) this.speed.append(new Option(`×${value}`, String(value)));
    this.speed.addEventListener("change", () => this.act(`speed ${this.speed.value}`));
    this.slider = document.createElement("input");
    this.slider.type = "range";
    this.slider.min = 0;
    this.slider.step = 100;
    this.slider.setAttribute("aria-label", "time");
    this.slider.addEventListener("input", () => this.drag());
    this.slider.addEventListener("change", () => this.seek(Number(this.slider.value)));
    this.place = element("output", "");
    this.lane = element("div", "", "marks");
    const row = element("div", "", "transport");
    row.append(this.play, this.back, this.on, this.speed, this.loop, this.place);
    const track = element("div", "", "track");
    track.append(this.lane, this.slider);
    new ResizeObserver(() => this.settle()).observe(this.lane);
    this.graphs = element("div", "", "graphs");
    this.host.replaceChildren(row, track, this.graphs);
    this.host.hidden = false;
  }

  setColours(colours) {
    this.colours = colours;
    if (this.curves) this.curves.setColours(colours);
  }

  setMarks(message) {
    this.marks = message;
    if (!this.play) this.build();
    this.curves = new Curves(this.graphs, message.curves, (t) => this.seek(Math.round(t * 1000 + message.zero_ms)));
    if (this.colours) this.curves.setColours(this.colours);
    this.drawMarks();
  }

  drawMarks() {
    if (!this.state || !this.marks) return;
    const length = Math.max(1, this.state.length_ms);
    this.lane.replaceChildren(...this.marks.marks.map((mark) => {
      const tick = element("button", mark.kind === "phase" ? mark.text : "", `mark ${mark.kind} ${mark.severity || ""}`);
      tick.style.left = `${(100 * mark.at_ms) / length}%`;
      tick.title = `${minutes(mark.at_ms)} ${mark.text}`;
      tick.tabIndex = mark.kind === "phase" ? 0 : -1;
      tick.addEventListener("click", () => this.seek(mark.at_ms));
      return tick;
    }));
    this.settle();
  }

  // Names of phases in two rows; one that would run out of the lane stands left of its tick, and one without room
  // anywhere has its tick alone (its words are the tick's title).
  settle() {
    const lane = this.lane.getBoundingClientRect();
    if (!lane.width) return;
    const rows = [[], []];
    const phases = [...this.lane.querySelectorAll(".mark.phase")];
    for (const tick of phases) tick.classList.remove("second", "left", "bare");
    for (const tick of phases) {
      const { left, width } = tick.getBoundingClientRect();
      const ways = [[left, false], [left - width, true]].filter(([at]) => at >= lane.left - 8 && at + width <= lane.right + 8);
      const free = ways.flatMap(([at, turned]) => rows.map((row, i) => [at, turned, i]))
        .find(([at, , i]) => rows[i].every(([from, to]) => at >= to || at + width <= from));
      if (!free) {
        tick.classList.add("bare");
        continue;
      }
      const [at, turned, row] = free;
      rows[row].push([at, at + width]);
      tick.classList.toggle("left", turned);
      tick.classList.toggle("second", row === 1);
    }
  }

  show(state) {
    const first = !this.state || this.state.length_ms !== state.length_ms;
    this.state = state;
    if (!this.play) this.build();
    this.slider.max = state.length_ms;
    if (first) this.drawMarks();
    this.play.textContent = state.playing ? "❚❚ pause" : "▶ play";
    this.loop.setAttribute("aria-pressed", state.loops);
    this.speed.value = String(state.speed);
    this.draw(state.at_ms);
  }

  // The scene is at this instant of the recording [ms since its begin].
  draw(at_ms) {
    if (document.activeElement !== this.slider || !this.dragged) this.slider.value = at_ms;
    const zero = this.marks ? this.marks.zero_ms : 0;
    const since = (at_ms - zero) / 1000;
    this.place.textContent = `${minutes(at_ms)} of ${minutes(this.state.length_ms)}, T${since < 0 ? "−" : "+"}${Math.abs(since).toFixed(1)} s`;
    if (this.curves) this.curves.cursor(since);
  }

  drag() {
    this.dragged = true;
    clearTimeout(this.later);
    const wait = this.sent + SEEK_EACH_MS - performance.now();
    const now = () => this.seek(Number(this.slider.value), true);
    if (wait <= 0) now();
    else this.later = setTimeout(now, wait);
  }

  seek(at_ms, dragged = false) {
    this.dragged = dragged;
    this.sent = performance.now();
    const length = this.state ? this.state.length_ms : at_ms;
    const at = Math.max(0, Math.min(length, Math.round(at_ms)));
    this.send({ do: "seek", at_ms: at });
    if (this.moved) this.moved({ since_ms: at - (this.marks ? this.marks.zero_ms : 0) });
  }

  act(action) {
    this.send({ do: "act", action });
    if (this.moved) this.moved({ action });
  }

  key(key) {
    if (this.host.hidden) return false;
    if (key === "[" || key === "]") this.toMark(key === "]" ? 1 : -1);
    else if (KEYS[key]) this.act(KEYS[key]);
    else return false;
    return true;
  }

  // To the next mark or the one before.
  toMark(way) {
    if (!this.marks || !this.state) return;
    const at = this.state.at_ms;
    const found = this.marks.marks.map((mark) => mark.at_ms).filter((each) => way * (each - at) > NEXT_MS);
    if (found.length) this.seek(way > 0 ? Math.min(...found) : Math.max(...found));
  }
}
