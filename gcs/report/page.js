"use strict";
// One instant is marked in all figures at once; figures over time share one window of time; the scene plays.
const flight = JSON.parse(document.getElementById("flight").textContent);
const tip = document.getElementById("tip"), panels = [];

function make(name, attributes, parent) {
  const made = document.createElementNS(parent.namespaceURI, name);
  for (const key in attributes) made.setAttribute(key, attributes[key]);
  return parent.appendChild(made);
}
function place(svg, event) { // of the pointer, in the drawing's units
  return new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
}
function between(rows, t) { // linear in the first column; null outside and in gaps
  let low = 0, high = rows.length - 1;
  if (high < 1 || !(t >= rows[0][0] && t <= rows[high][0])) return null; // NaN is no instant
  while (high - low > 1) { const middle = (low + high) >> 1; if (rows[middle][0] <= t) low = middle; else high = middle; }
  const [a, b] = [rows[low], rows[high]], share = b[0] > a[0] ? (t - a[0]) / (b[0] - a[0]) : 0;
  return b.gap ? null : a.map((value, n) => value + share * (b[n] - value));
}
function points(path) { // of a curve, as drawn; a move of the pen is a gap
  return [...path.getAttribute("d").matchAll(/([ML]) (\S+) ([\d.-]+)/g)].map(([, pen, x, y], n) =>
    Object.assign([+x, +y], { gap: pen === "M" && n > 0 }));
}
function rounds(low, high) { // round values from low to high, about six
  const rough = (high - low) / 6, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find(s => s * power >= rough) * power, found = [];
  for (let n = Math.ceil(low / step); n * step <= high; n++) found.push(+(n * step).toPrecision(12));
  return found;
}

function words(value) { return String(value).replace("-", "\u2212"); }

class Panel { // axes over time, or the plan
  constructor(svg, name, given) {
    Object.assign(this, given, { svg, name, axes: svg.querySelector(`[id="${name}-${given.gid}"]`), moved: [] });
    [this.x0, this.x1, this.west, this.east] = this.x; [this.y0, this.y1, this.south, this.north] = this.y;
    this.whole = this.shown = [this.west, this.east, this.south, this.north];
    for (const part of this.axes.querySelectorAll("[clip-path]")) {
      if (part.closest('[id*="tick_"]')) continue;
      const frame = make("g", { "clip-path": part.getAttribute("clip-path") }, part.parentNode);
      part.parentNode.replaceChild(frame, part); frame.append(part); part.removeAttribute("clip-path");
      this.moved.push(part);
    }
    for (const part of this.axes.querySelectorAll("use, text")) part.at = [+part.getAttribute("x"), +part.getAttribute("y")];
    this.curves = this.series.map(([gid, who, colour, scale, zero]) => {
      const path = this.axes.querySelector(`[id="${name}-${gid}"] path`);
      return { who, colour, scale, zero, rows: path ? points(path) : [] };
    });
    this.marks = make("g", {}, svg);
  }
  toX(value) { return this.x0 + (value - this.shown[0]) / (this.shown[1] - this.shown[0]) * (this.x1 - this.x0); }
  toY(value) { return this.y0 + (value - this.shown[2]) / (this.shown[3] - this.shown[2]) * (this.y1 - this.y0); }
  ofX(x) { return this.shown[0] + (x - this.x0) / (this.x1 - this.x0) * (this.shown[1] - this.shown[0]); }
  ofY(y) { return this.shown[2] + (y - this.y0) / (this.y1 - this.y0) * (this.shown[3] - this.shown[2]); }
  holds(p) { return p.x >= this.x0 && p.x <= this.x1 && p.y <= this.y0 && p.y >= this.y1; }
  show(shown) { // another part of what was drawn
    this.shown = shown;
    const [w, e, s, n] = this.whole;
    const kx = (e - w) / (shown[1] - shown[0]), ky = (n - s) / (shown[3] - shown[2]);
    const ax = this.toX(w) - kx * this.x0, ay = this.toY(s) - ky * this.y0;
    const zoomed = shown !== this.whole, plan = this.kind === "plan";
    const unit = this.svg.getBoundingClientRect().width / this.svg.viewBox.baseVal.width; // strokes stay as wide as they are
    for (const part of this.moved) {
      if (part.tagName === "path") {
        part.setAttribute("transform", `matrix(${kx} 0 0 ${ky} ${ax} ${ay})`);
        part.wide ??= parseFloat(part.style.strokeWidth);
        part.style.strokeWidth = part.wide * (zoomed ? unit : 1);
      }
      for (const one of part.matches("text") ? [part] : part.querySelectorAll("use, text")) {
        one.setAttribute("x", ax + kx * one.at[0]); one.setAttribute("y", ay + ky * one.at[1]);
      }
    }
    for (const one of this.axes.querySelectorAll('[id*="-phase"] text')) {
      const x = ax + kx * one.at[0];
      one.setAttribute("x", x);
      one.style.display = x >= this.x0 - 1 && x <= this.x1 ? "" : "none";
    }
    this.axes.querySelectorAll('[id*="-matplotlib.axis"]').forEach((axis, n) =>
      axis.classList.toggle("zoomed", zoomed && (n === 0 || plan)));
    this.moved.forEach(part => part.parentNode.classList.toggle("zoomed", zoomed));
    this.ticks?.remove();
    if (!zoomed) return;
    this.ticks = make("g", { class: "ticks" }, this.svg);
    this.axes.before(this.ticks);
    for (const value of rounds(shown[0], shown[1])) {
      const x = this.toX(value);
      make("line", { x1: x, x2: x, y1: this.y0, y2: this.y1 }, this.ticks);
      if (this.axes.querySelector('[id*="xtick_"] text'))
        make("text", { x, y: this.y0 + 14, "text-anchor": "middle" }, this.ticks).textContent = words(value);
    }
    for (const value of plan ? rounds(shown[2], shown[3]) : []) {
      const y = this.toY(value);
      make("line", { x1: this.x0, x2: this.x1, y1: y, y2: y }, this.ticks);
      make("text", { x: this.x0 - 7, y: y + 3, "text-anchor": "end" }, this.ticks).textContent = words(value);
    }
  }
  mark(t) { // the instant: a line over time, dots in the plan
    this.marks.replaceChildren();
    if (this.kind === "time" && t >= this.shown[0] && t <= this.shown[1])
      make("line", { class: "cursor", x1: this.toX(t), x2: this.toX(t), y1: this.y0, y2: this.y1 }, this.marks);
    if (this.kind === "plan") for (const way of flight.ways) {
      const at = between(way.rows, t);
      if (at) dot(this.marks, this.toX(at[1]), this.toY(at[2]), way.colour);
    }
  }
  told(t, p) { // what there is to read at an instant
    const x = this.x0 + (t - this.whole[0]) / (this.whole[1] - this.whole[0]) * (this.x1 - this.x0), lines = [];
    const digits = this.unit === "%" || this.unit === "°" ? 0 : 2;
    for (const { who, colour, scale, zero, rows } of this.curves) {
      const at = between(rows, x);
      if (!at) continue;
      const y = this.whole[2] + (at[1] - this.y0) / (this.y1 - this.y0) * (this.whole[3] - this.whole[2]);
      lines.push([colour, `${who}: ${(scale * (y - zero)).toFixed(digits)} ${this.unit}`]);
    }
    for (const [who, bars] of this.lanes)
      for (const [start, end, text, colour] of bars) if (t >= start && t < end) lines.push([colour, `${who}: ${text}`]);
    return this.kind === "plan" ? ways(t) : lines;
  }
  nearest(p) { // the instant that the pointer is at; in the plan, of the nearest way
    if (this.kind === "time") return this.ofX(p.x);
    return closest(p, row => [this.toX(row[1]), this.toY(row[2])]);
  }
}

function dot(parent, x, y, colour) {
  make("circle", { cx: x, cy: y, r: 4.5, stroke: "var(--paper)", style: `fill: var(--c${colour.slice(1)})` }, parent);
}
function ways(t) {
  return flight.ways.flatMap(({ name, colour, rows }) => {
    const at = between(rows, t);
    return at ? [[colour, `${name}: east ${at[1].toFixed(1)}, north ${at[2].toFixed(1)}, height ${at[3].toFixed(1)} m`]] : [];
  });
}
function closest(p, seen) { // the instant of the sample drawn nearest to the pointer, within 25 units
  let best = 25, found = null;
  for (const { rows } of flight.ways) for (const row of rows) {
    const [x, y] = seen(row), d = Math.hypot(x - p.x, y - p.y);
    if (d < best) [best, found] = [d, row[0]];
  }
  return found;
}

function mark(t) { for (const one of panels) one.mark(t); }
function tell(event, one, t) {
  const lines = t === null ? [] : one.told(t);
  tip.replaceChildren();
  tip.append(t === null ? "" : `${t.toFixed(2)} s`);
  for (const [colour, text] of lines) {
    const row = document.createElement("div"), sign = document.createElement("span");
    sign.className = "dot"; sign.style.background = `var(--c${colour.slice(1)})`;
    row.append(sign, text); tip.append(row);
  }
  tip.style.display = lines.length ? "block" : "none";
  const right = event.clientX + tip.offsetWidth + 24 > innerWidth, low = event.clientY + tip.offsetHeight + 24 > innerHeight;
  tip.style.left = `${right ? Math.max(0, event.clientX - tip.offsetWidth - 14) : event.clientX + 14}px`;
  tip.style.top = `${low ? Math.max(0, event.clientY - tip.offsetHeight - 14) : event.clientY + 14}px`;
}
function zoom(panel, a, b) { // to the rectangle between two places; figures over time go together
  const [w, e] = [panel.ofX(Math.min(a.x, b.x)), panel.ofX(Math.max(a.x, b.x))];
  if (panel.kind === "time") { for (const p of panels) if (p.kind === "time") p.show([w, e, ...p.whole.slice(2)]); return; }
  const wide = Math.max(e - w, Math.abs(panel.ofY(a.y) - panel.ofY(b.y)) * (panel.x1 - panel.x0) / (panel.y0 - panel.y1));
  const high = wide * (panel.y0 - panel.y1) / (panel.x1 - panel.x0);
  const [east, north] = [panel.ofX((a.x + b.x) / 2), panel.ofY((a.y + b.y) / 2)];
  panel.show([east - wide / 2, east + wide / 2, north - high / 2, north + high / 2]);
}
function listen(svg, own) {
  let from = null, chosen = null, one = null;
  svg.addEventListener("pointerdown", event => {
    const p = place(svg, event);
    one = own.find(panel => panel.holds(p));
    if (!one || event.button || event.pointerType !== "mouse") return;
    from = p;
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener("pointermove", event => {
    const p = place(svg, event), over = own.find(panel => panel.holds(p));
    if (from) {
      chosen?.remove();
      const time = one.kind === "time", top = time ? one.y1 : Math.min(from.y, p.y);
      chosen = make("rect", { class: "chosen", x: Math.min(from.x, p.x), width: Math.abs(p.x - from.x), y: top,
        height: time ? one.y0 - one.y1 : Math.abs(p.y - from.y) }, svg);
      return;
    }
    const t = over ? over.nearest(p) : null;
    mark(t ?? NaN);
    if (t !== null && window.playback && !window.playback.playing) window.playback.move(t);
    if (over) tell(event, over, t); else tip.style.display = "none";
  });
  svg.addEventListener("pointerup", event => {
    const p = place(svg, event);
    chosen?.remove();
    if (from && Math.hypot(p.x - from.x, p.y - from.y) > 6 && Math.abs(p.x - from.x) > 2) zoom(one, from, p);
    from = chosen = null;
  });
  svg.addEventListener("pointerleave", () => { if (!from) { tip.style.display = "none"; mark(NaN); } });
  svg.addEventListener("dblclick", () => {
    for (const p of panels) if (own.includes(p) || (p.kind === "time" && own[0].kind === "time")) p.show(p.whole);
  });
}

for (const { name, panels: given } of flight.figures) {
  const svg = document.querySelector(`#figure-${name} svg`);
  const own = given.map(one => new Panel(svg, name, one));
  panels.push(...own);
  listen(svg, own);
}
const stage = document.getElementById("stage");
if (stage && flight.scene) {
  try {
    window.playback = new Playback(stage, document.getElementById("time"), flight.scene, mark);
  } catch { // no WebGL: the drawing for paper takes its place
    document.body.classList.add("flat");
  }
}
