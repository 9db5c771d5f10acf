// The ways of the last minute, drawn at once: a row of pieces for each step of time, a column for each body.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage, LineBasicMaterial, LineSegments } from "three";

const LONG_MS = 60000; // of way
const PIECES = 24000; // of all bodies together
const ROWS = [12, 240]; // steps of time, at least and at most
const PIECE = 6; // numbers: from, to
const RANGES = 64; // rows that wait to be drawn, before all are sent anew

export class Trails {
  constructor() {
    const material = new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.75 });
    this.lines = new LineSegments(new BufferGeometry(), material);
    this.lines.frustumCulled = false;
    this.bodies = new Map(); // key (`v2`, `t1`) → {column, points, at}: where it was at each step, and is
    this.colour = null; // key → Color
    this.room = 0; // columns
    this.restart(16);
  }

  // Room for so many bodies, with the ways that are kept.
  restart(room) {
    this.room = room;
    this.rows = Math.max(ROWS[0], Math.min(ROWS[1], Math.floor(PIECES / room)));
    this.stepMs = LONG_MS / this.rows;
    this.lines.geometry.dispose();
    this.lines.geometry = new BufferGeometry();
    for (const name of ["position", "color"]) {
      const attribute = new BufferAttribute(new Float32Array(this.rows * room * PIECE), 3);
      this.lines.geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    }
    this.lines.geometry.attributes.position.onUpload(() => { this.whole = false; });
    this.set([...this.bodies].map(([key, body]) => [key, [...body.points, body.at]]));
  }

  // These ways alone: pairs of a key and its places, the newest last.
  set(given) {
    const ways = given.filter(([, points]) => points.length);
    if (ways.length > this.room) {
      this.bodies = new Map(ways.map(([key, points]) => [key, { points: points.slice(0, -1), at: points[points.length - 1] }]));
      this.restart(Math.max(ways.length, 2 * this.room));
      return;
    }
    this.bodies = new Map();
    this.head = 0;
    this.stepped = null;
    const thinned = ways.map(([key, points]) => {
      const stride = Math.ceil(points.length / (this.rows - 1));
      return [key, points.filter((_, i) => (points.length - 1 - i) % stride === 0)];
    });
    const longest = Math.max(0, ...thinned.map(([, points]) => points.length - 1));
    const { array } = this.lines.geometry.attributes.position;
    array.fill(0);
    for (const [key, points] of thinned) {
      const body = { column: this.bodies.size, points, at: points[points.length - 1] };
      this.bodies.set(key, body);
      const first = longest - points.length + 1;
      for (let i = 1; i < points.length; i += 1) this.write(first + i - 1, body.column, points[i - 1], points[i]);
    }
    this.head = longest;
    this.full = false;
    this.whole = true;
    this.shown();
    this.setColour(this.colour);
  }

  write(row, column, from, to) {
    const { array } = this.lines.geometry.attributes.position;
    const at = (row * this.room + column) * PIECE;
    for (let axis = 0; axis < 3; axis += 1) {
      array[at + axis] = from[axis];
      array[at + 3 + axis] = to[axis];
    }
  }

  // `colour(key)` is that of a body.
  setColour(colour) {
    this.colour = colour;
    if (!colour) return;
    for (const [key, body] of this.bodies) this.dye(key, body.column);
  }

  dye(key, column) {
    const { color } = this.lines.geometry.attributes;
    const { r, g, b } = this.colour(key);
    for (let row = 0; row < this.rows; row += 1) color.array.set([r, g, b, r, g, b], (row * this.room + column) * PIECE);
    color.needsUpdate = true;
  }

  // A body is there now.
  extend(key, point) {
    const body = this.bodies.get(key);
    if (body) {
      body.at = point;
      return;
    }
    if (this.bodies.size >= this.room) this.restart(2 * this.room);
    this.bodies.set(key, { column: this.bodies.size, points: [point], at: point });
    if (this.colour) this.dye(key, this.bodies.size - 1);
  }

  // All bodies have been extended to this instant [ms].
  end(ms) {
    this.draw();
    if (this.stepped === null) this.stepped = ms;
    if (ms >= this.stepped && ms - this.stepped < this.stepMs) return;
    this.stepped = ms;
    for (const body of this.bodies.values()) {
      body.points.push(body.at);
      if (body.points.length > this.rows) body.points.shift();
    }
    this.full = this.full || this.head + 1 === this.rows;
    this.head = (this.head + 1) % this.rows;
    const { array } = this.lines.geometry.attributes.position;
    array.fill(0, this.head * this.room * PIECE, (this.head + 1) * this.room * PIECE);
    this.draw();
  }

  // The row of now: from where each was at the last step to where it is.
  draw() {
    for (const { column, points, at } of this.bodies.values()) this.write(this.head, column, points[points.length - 1], at);
    this.shown();
  }

  shown() {
    const { position } = this.lines.geometry.attributes;
    const size = this.room * PIECE;
    if (this.whole || position.updateRanges.length >= RANGES) {
      this.whole = true;
      position.clearUpdateRanges();
    } else position.addUpdateRange(this.head * size, size);
    position.needsUpdate = true;
    this.lines.geometry.setDrawRange(0, 2 * this.room * (this.full ? this.rows : this.head + 1));
  }
}
