// The scene: camera, light, picking, labels. One for the live page, for a replay and for a report.
import {
  AmbientLight, Color, DirectionalLight, OrthographicCamera, PerspectiveCamera, Plane, Raycaster, Scene as World,
  Vector2, Vector3, WebGLRenderer, MOUSE, TOUCH,
} from "three";
import { OrbitControls } from "three";
import { Fleet } from "fleet";
import { Ground, round } from "ground";
import { place } from "frames";
import { Names } from "names";
import { severalEvaders } from "colours";

const BODY_PX = 22; // length of a vehicle on the screen, where that is more than
const BODY_M = 2; // its length in the world
const WAIT_MS = 150; // for the next frame
const NAMES_ALL = 40; // vehicles that are all named; of more those whose names have room
const OLD_S = 2; // a track that is older leaves no way
const FLOOR = new Plane(new Vector3(0, 1, 0), 0);
const seat = new Vector3(); // for sums

// Whether edges are smoothed: where there is a graphics card, or where the address asks for it. Without one that would
// be half of all the work.
function smooth() {
  if (new URLSearchParams(window.location.search).has("smooth")) return true;
  const probe = document.createElement("canvas").getContext("webgl2");
  const told = probe && probe.getExtension("WEBGL_debug_renderer_info");
  const card = told ? String(probe.getParameter(told.UNMASKED_RENDERER_WEBGL)) : "";
  const end = probe && probe.getExtension("WEBGL_lose_context");
  if (end) end.loseContext();
  return !/swiftshader|llvmpipe|softpipe|software|basic render/i.test(card);
}

export class Scene {
  // `host` is an element that it fills; `on.pick(id)` and `on.pointer(north, east)` are called.
  constructor(host, on = {}) {
    this.host = host;
    this.on = on;
    this.renderer = new WebGLRenderer({ antialias: smooth(), preserveDrawingBuffer: true });
    this.renderer.domElement.className = "canvas3";
    this.labels = document.createElement("canvas");
    this.labels.className = "labels";
    host.append(this.renderer.domElement, this.labels);
    this.world = new World();
    this.world.add(new AmbientLight(0xffffff, 1.6));
    const sun = new DirectionalLight(0xffffff, 1.8);
    sun.position.set(0.4, 1, 0.6);
    this.world.add(sun);
    this.fleet = new Fleet();
    this.ground = new Ground();
    this.world.add(this.ground.group, this.fleet.group);
    this.reach = 200;
    this.centre = new Vector3();
    this.perspective = new PerspectiveCamera(45, 1, 1, 1e6);
    this.flat = new OrthographicCamera(-1, 1, 1, -1, -1e5, 1e5);
    this.view = "space";
    this.orbit = new OrbitControls(this.perspective, this.renderer.domElement);
    this.orbit.maxPolarAngle = Math.PI / 2 - 0.02;
    this.plan = new OrbitControls(this.flat, this.renderer.domElement);
    this.plan.enableRotate = false;
    this.plan.screenSpacePanning = true;
    this.plan.mouseButtons = { LEFT: MOUSE.PAN, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
    this.plan.touches = { ONE: TOUCH.PAN, TWO: TOUCH.DOLLY_PAN };
    this.plan.enabled = false;
    this.fitted = false;
    this.kept = true; // fitted until somebody moves the camera
    this.following = null;
    this.selected = null;
    this.shown = { labels: true, trails: true, aims: true, shapes: true, relations: true };
    this.where = new Map();
    this.drawn = 0;
    this.names = new Names();
    this.dirty = true;
    this.later = null; // since when something waits that is drawn with the next frame
    for (const controls of [this.orbit, this.plan]) {
      controls.addEventListener("change", () => { this.dirty = true; });
      controls.addEventListener("start", () => { this.kept = false; });
    }
    this.renderer.domElement.addEventListener("pointerdown", (event) => { this.pressed = [event.clientX, event.clientY]; });
    this.renderer.domElement.addEventListener("pointerup", (event) => this.released(event));
    this.renderer.domElement.addEventListener("pointermove", (event) => this.pointed(event));
    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
    const draw = () => {
      requestAnimationFrame(draw);
      this.draw();
    };
    requestAnimationFrame(draw);
  }

  get camera() {
    return this.view === "plan" ? this.flat : this.perspective;
  }

  get controls() {
    return this.view === "plan" ? this.plan : this.orbit;
  }

  setColours(colours) {
    this.colours = colours;
    this.world.background = new Color(colours.paper);
    this.fleet.setColours(colours);
    this.ground.setColours(colours);
    this.dirty = true;
  }

  setField(field) {
    this.field = field;
    this.fleet.expected = (field.roster || []).filter(({ role }) => role === "evader").map(({ id }) => id);
    this.ground.setField(field, this.reach);
    this.fitted = false;
    this.dirty = true;
  }

  setTrails(trails) {
    const ways = (kind, found) => Object.entries(found).map(([id, way]) => [`${kind}${id}`, way.map(place)]);
    this.fleet.trails.set([...ways("v", trails.vehicles), ...ways("t", trails.tracks)]);
    this.dirty = true;
  }

  // One frame of what moves, with the names of its roles.
  setFrame(frame, roles) {
    this.frame = frame;
    this.roles = roles;
    this.where = new Map(frame.vehicles.map((v) => [v.id, [v.x, v.y, v.z]]));
    const { trails } = this.fleet;
    for (const v of frame.vehicles) if (v.fed) trails.extend(`v${v.id}`, this.where.get(v.id));
    for (const t of frame.tracks) if (t.age < OLD_S) trails.extend(`t${t.id}`, [t.x, t.y, t.z]);
    trails.end(frame.ms);
    this.ground.setEvaders(this.evaders());
    if (!this.fitted && frame.vehicles.length) this.fit();
    if (this.following !== null) this.follow();
    this.fleet.show(frame.vehicles, frame.tracks, (x, y, z) => this.bodySize(x, y, z), roles);
    this.fresh = true;
    this.dirty = true;
  }

  // Where the evaders in the game are, by id: by their own word, else by their tracks.
  evaders() {
    const { vehicles, tracks } = this.frame;
    const told = vehicles.filter((v) => this.roles[v.role] === "evader");
    const seen = told.length ? tracks.filter((t) => this.fleet.expected.includes(t.id)) : tracks;
    const found = new Map([...seen, ...told].map((v) => [v.id, [v.x, v.y, v.z]]));
    const playing = [...found].filter(([id]) => !this.fleet.out.has(id));
    return playing.length ? new Map(playing) : found;
  }

  setBoard(board) {
    this.board = board;
    const game = board.game || {};
    this.out = new Map((game.out || []).map(({ id, word }) => [id, word]));
    this.fleet.out = severalEvaders() ? new Set(this.out.keys()) : new Set();
    this.after = new Map(game.quarries || []);
    if (this.frame) this.ground.setEvaders(this.evaders());
    this.parts = new Map(((game.plan && game.plan.parts) || []).map((part) => [part.id, part.role]));
    this.ground.setAims(this.shown.aims ? board.aims : [], this.where, this.selected);
    this.ground.setChases(this.shown.aims ? this.after : new Map(), this.where);
    const known = (board.knowledge || []).find(({ evader }) => evader === this.knownEvader());
    this.ground.setArcs(this.shown.relations && known ? known.arcs : []);
    this.ground.setGaps(this.shown.shapes && board.situation ? board.situation.evaders : []);
    this.wait();
  }

  // The evader whose game is told: the selected one, or whom the selected one is after; else the first.
  knownEvader() {
    const ids = ((this.board && this.board.knowledge) || []).map(({ evader }) => evader);
    return [this.selected, this.after && this.after.get(this.selected), ids[0]].find((id) => ids.includes(id));
  }

  // Draw what is new with the next frame, soon in any case: drawing is what costs most.
  wait() {
    this.later = this.later === null ? performance.now() : this.later;
  }

  // Where the evaders' tracks will be.
  setFans(message) {
    this.fans = message;
    this.ground.setFans(this.shown.shapes ? message.fans : [], message.marks);
    this.wait();
  }

  setDetail(detail) {
    this.ground.setDecision(this.shown.shapes ? detail.decision : null, this.where.get(detail.id));
    this.wait();
  }

  select(id) {
    this.selected = id;
    if (id === null) this.ground.setDecision(null);
    if (this.board) this.setBoard(this.board);
  }

  show(what, on) {
    this.shown[what] = on;
    this.fleet.trails.lines.visible = this.shown.trails;
    this.ground.chosen.visible = this.shown.shapes;
    if (this.board) this.setBoard(this.board);
    if (this.fans) this.setFans(this.fans);
    this.dirty = true;
  }

  setView(view) {
    this.view = view;
    this.orbit.enabled = view !== "plan";
    this.plan.enabled = view === "plan";
    this.fit();
  }

  bodySize(x, y, z) {
    const perPixel = this.metresPerPixel(x, y, z);
    return Math.max(BODY_M, BODY_PX * perPixel);
  }

  metresPerPixel(x, y, z) {
    if (this.view === "plan") return (this.flat.top - this.flat.bottom) / this.flat.zoom / this.height;
    const away = this.perspective.position.distanceTo(seat.set(x, y, z));
    return (2 * away * Math.tan((this.perspective.fov * Math.PI) / 360)) / this.height;
  }

  // Put everything into view: vehicles, tracks, targets; the fence where nobody is there yet.
  fit() {
    const places = [...this.where.values()];
    if (this.frame) for (const t of this.frame.tracks) places.push([t.x, t.y, t.z]);
    if (this.field) for (const goal of this.field.targets) places.push(place(goal.place));
    if (!places.length && this.field && this.field.fence) {
      for (const [n, e] of this.field.fence.polygon) places.push([e, 0, -n]);
    }
    if (!places.length) return;
    const low = [0, 1, 2].map((a) => Math.min(...places.map((p) => p[a])));
    const high = [0, 1, 2].map((a) => Math.max(...places.map((p) => p[a])));
    this.centre.set((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2);
    const radius = Math.max(20, 0.5 * Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]));
    if (Math.abs(Math.log(radius / this.reach)) > 0.3) {
      this.reach = radius;
      if (this.field && this.colours) this.ground.setField(this.field, radius);
    }
    const aspect = this.width / this.height;
    const away = (1.25 * radius) / Math.tan((this.perspective.fov * Math.PI) / 360) / Math.min(1, aspect);
    this.perspective.position.set(this.centre.x - 0.25 * away, this.centre.y + 0.55 * away, this.centre.z + 0.8 * away);
    this.perspective.near = away / 200;
    this.perspective.far = away * 60;
    this.orbit.target.copy(this.centre);
    const half = (1.2 * radius) / Math.min(1, aspect);
    Object.assign(this.flat, { top: half, bottom: -half, left: -half * aspect, right: half * aspect, zoom: 1 });
    this.flat.position.set(this.centre.x, this.centre.y + 1000, this.centre.z);
    this.flat.up.set(0, 0, -1);
    this.plan.target.copy(this.centre);
    this.fitted = true;
    this.kept = true;
    this.resize();
  }

  follow() {
    const at = this.where.get(this.following);
    if (!at) return;
    const step = new Vector3(...at).sub(this.controls.target);
    this.controls.target.add(step);
    this.camera.position.add(step);
  }

  resize() {
    const width = Math.max(1, this.host.clientWidth);
    const height = Math.max(1, this.host.clientHeight);
    Object.assign(this, { width, height }); // asking the browser each time would make it lay the page out each time
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setSize(width, height, false);
    const ratio = window.devicePixelRatio || 1;
    this.labels.width = width * ratio;
    this.labels.height = height * ratio;
    this.perspective.aspect = width / height;
    const half = (this.flat.top - this.flat.bottom) / 2;
    this.flat.left = (-half * width) / height;
    this.flat.right = (half * width) / height;
    this.perspective.updateProjectionMatrix();
    this.flat.updateProjectionMatrix();
    this.orbit.update();
    this.plan.update();
    this.dirty = true;
  }

  draw() {
    this.controls.update();
    if (this.later !== null && performance.now() - this.later > WAIT_MS) this.dirty = true;
    if (!this.dirty || !this.colours) return;
    this.dirty = false;
    this.later = null;
    this.renderer.render(this.world, this.camera);
    this.drawLabels();
    this.drawn += 1;
    if (this.fresh && this.on.drawn) this.on.drawn(this.frame);
    this.fresh = false;
  }

  // A place on the screen [px], null behind the camera.
  onScreen(x, y, z) {
    const at = seat.set(x, y, z).project(this.camera);
    if (at.z > 1 || at.z < -1) return null;
    return [((at.x + 1) / 2) * this.width, ((1 - at.y) / 2) * this.height];
  }

  drawLabels() {
    const ratio = window.devicePixelRatio || 1;
    const pen = this.labels.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, this.width, this.height);
    pen.font = "600 12px system-ui, sans-serif";
    pen.textBaseline = "middle";
    if (this.shown.labels) this.drawNames(pen);
    this.drawScale(pen);
    this.drawNorth(pen);
    if (this.board && this.board.wind) this.drawWind(pen, this.board.wind);
  }

  text(pen, text, x, y, colour) {
    pen.lineWidth = 3;
    pen.strokeStyle = this.colours.paper;
    pen.strokeText(text, x, y);
    pen.fillStyle = colour;
    pen.fillText(text, x, y);
  }

  name(pen, text, at, colour, how) {
    const place = this.names.put(pen, text, at, how);
    if (place) this.text(pen, text, ...place, colour);
  }

  drawNames(pen) {
    const { colours } = this;
    this.names.clear();
    const vehicles = this.frame ? this.frame.vehicles : [];
    const first = (v) => v.id === this.selected || this.roles[v.role] === "evader";
    const crowd = vehicles.length > NAMES_ALL;
    for (const v of crowd ? [...vehicles.filter(first), ...vehicles.filter((v) => !first(v))] : vehicles) {
      const at = this.onScreen(v.x, v.y, v.z);
      if (!at) continue;
      const name = this.nameOf(v);
      const how = { away: v.id === this.selected ? 19 : 12, must: !crowd || first(v) };
      this.name(pen, v.fed ? name : `${name} ?`, at, v.fed ? colours.ink : colours.faint, how);
      if (v.id === this.selected) {
        pen.strokeStyle = colours.ink;
        pen.lineWidth = 2;
        pen.beginPath();
        pen.arc(at[0], at[1], 16, 0, 2 * Math.PI);
        pen.stroke();
      }
    }
    for (const goal of this.field ? this.field.targets : []) {
      const at = this.onScreen(...place(goal.place));
      if (at) this.name(pen, goal.name, at, colours.ink);
    }
    for (const arc of this.ground.named) {
      const at = this.onScreen(...arc.at);
      if (at) this.name(pen, arc.words, at, colours.faint, { away: 4, must: false });
    }
    for (const zone of this.ground.zones) {
      const at = this.onScreen(...zone.at);
      if (at) this.name(pen, zone.name, at, colours.faint, { away: 6, must: false });
    }
    this.ground.expected.forEach(({ after, at: [x, y, z] }) => {
      const at = this.onScreen(x, y, z);
      if (at) this.name(pen, `+${after} s`, at, colours.faint, { away: 6, must: false });
    });
  }

  // A vehicle's id with what it is there for: `12 evader`, `4 ring`, of several evaders `4 ring → 12`.
  nameOf(v) {
    const evader = this.roles[v.role] === "evader";
    const out = this.out && severalEvaders() ? this.out.get(v.id) : undefined;
    const part = evader ? out || "evader" : (this.parts && this.parts.get(v.id)) || "";
    const after = this.after && this.after.get(v.id);
    return [v.id, part, after ? `→ ${after}` : ""].filter(Boolean).join(" ");
  }

  drawScale(pen) {
    const { x, y, z } = this.controls.target;
    const metres = round(110 * this.metresPerPixel(x, y, z));
    const width = metres / this.metresPerPixel(x, y, z);
    const bottom = this.height - 18;
    pen.strokeStyle = this.colours.ink;
    pen.lineWidth = 2;
    pen.beginPath();
    pen.moveTo(16, bottom - 5);
    pen.lineTo(16, bottom);
    pen.lineTo(16 + width, bottom);
    pen.lineTo(16 + width, bottom - 5);
    pen.stroke();
    const words = metres >= 1000 ? `${metres / 1000} km` : `${metres} m`;
    this.text(pen, this.view === "plan" ? words : `${words} at the middle`, 22 + width, bottom - 2, this.colours.ink);
  }

  arrow(pen, x, y, dx, dy, colour) {
    const length = Math.hypot(dx, dy) || 1;
    const [u, w] = [dx / length, dy / length];
    pen.strokeStyle = colour;
    pen.fillStyle = colour;
    pen.lineWidth = 2.5;
    pen.beginPath();
    pen.moveTo(x - 14 * u, y - 14 * w);
    pen.lineTo(x + 8 * u, y + 8 * w);
    pen.stroke();
    pen.beginPath();
    pen.moveTo(x + 16 * u, y + 16 * w);
    pen.lineTo(x + 6 * u - 5 * w, y + 6 * w + 5 * u);
    pen.lineTo(x + 6 * u + 5 * w, y + 6 * w - 5 * u);
    pen.fill();
  }

  // A direction over the ground (east, south) as it lies on the screen.
  lies(east, south) {
    const { x, y, z } = this.controls.target;
    const from = this.onScreen(x, y, z);
    const far = this.reach / 10;
    const to = this.onScreen(x + east * far, y, z + south * far);
    return from && to ? [to[0] - from[0], to[1] - from[1]] : [0, -1];
  }

  drawNorth(pen) {
    const x = this.width - 34;
    this.arrow(pen, x, 40, ...this.lies(0, -1), this.colours.faint);
    this.text(pen, "N", x - 4, 70, this.colours.faint);
  }

  drawWind(pen, wind) {
    const speed = Math.hypot(wind[0], wind[1]);
    if (speed < 0.05) return;
    const x = this.width - 34;
    this.arrow(pen, x, 108, ...this.lies(wind[1] / speed, -wind[0] / speed), this.colours.apollonius);
    this.text(pen, `wind ${speed.toFixed(1)} m/s`, x - 62, 140, this.colours.ink);
  }

  ground_at(event) {
    const box = this.renderer.domElement.getBoundingClientRect();
    const pointer = new Vector2(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    const ray = new Raycaster();
    ray.setFromCamera(pointer, this.camera);
    const at = new Vector3();
    return ray.ray.intersectPlane(FLOOR, at) ? [-at.z, at.x] : null;
  }

  pointed(event) {
    if (this.on.pointer) this.on.pointer(this.ground_at(event));
  }

  released(event) {
    if (!this.pressed || Math.hypot(event.clientX - this.pressed[0], event.clientY - this.pressed[1]) > 5) return;
    const box = this.renderer.domElement.getBoundingClientRect();
    const [px, py] = [event.clientX - box.left, event.clientY - box.top];
    let best = null;
    let least = 24;
    for (const [id, [x, y, z]] of this.where) {
      const at = this.onScreen(x, y, z);
      const away = at ? Math.hypot(at[0] - px, at[1] - py) : Infinity;
      if (away < least) [best, least] = [id, away];
    }
    if (best !== null && this.on.pick) this.on.pick(best);
  }
}
