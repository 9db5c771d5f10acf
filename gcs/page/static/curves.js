// Curves over time with one cursor: lines with levels, and rows of bands. Drawn on canvases, for page and report.

const HEIGHT = 92;
const ROW = 15;
const LEFT = 44;
const RIGHT = 8;

export function ticks(low, high, most) {
  const span = Math.max(high - low, 1e-9);
  const power = 10 ** Math.floor(Math.log10(span / most));
  const step = [1, 2, 5, 10].map((s) => s * power).find((s) => span / s <= most) || 10 * power;
  const found = [];
  for (let value = Math.ceil(low / step) * step; value <= high + 1e-9; value += step) found.push(Number(value.toFixed(6)));
  return found;
}

export class Curves {
  // `seek(t)`: somebody pressed at this time [s since t₀].
  constructor(host, curves, seek) {
    this.curves = curves;
    this.at = 0;
    let [low, high] = [Infinity, -Infinity];
    for (const curve of curves) {
      for (const line of curve.lines || []) [low, high] = [Math.min(low, line.t[0]), Math.max(high, line.t[line.t.length - 1])];
      for (const row of curve.rows || []) for (const band of row.bands) [low, high] = [Math.min(low, band[0]), Math.max(high, band[1])];
    }
    this.low = Number.isFinite(low) ? low : 0;
    this.high = high > this.low ? high : this.low + 1;
    this.parts = curves.map((curve) => {
      const box = document.createElement("figure");
      const title = document.createElement("figcaption");
      title.textContent = curve.unit ? `${curve.name} [${curve.unit}]` : curve.name;
      const said = document.createElement("output");
      title.append(" ", said);
      const canvas = document.createElement("canvas");
      canvas.height = curve.rows ? ROW * curve.rows.length + 20 : HEIGHT;
      canvas.addEventListener("pointerdown", (event) => seek(this.timeAt(canvas, event)));
      box.append(title, canvas);
      return { curve, canvas, said, height: canvas.height };
    });
    host.replaceChildren(...this.parts.map((part) => part.canvas.parentElement));
    new ResizeObserver(() => this.draw()).observe(host);
  }

  setColours(colours) {
    this.colours = colours;
    this.draw();
  }

  timeAt(canvas, event) {
    const box = canvas.getBoundingClientRect();
    const share = (event.clientX - box.left - LEFT) / Math.max(1, box.width - LEFT - RIGHT);
    return this.low + Math.max(0, Math.min(1, share)) * (this.high - this.low);
  }

  // The cursor is moved often, what stands still is drawn once.
  cursor(t) {
    if (Math.abs(t - this.at) < 0.02) return;
    this.at = t;
    if (!this.colours) return;
    for (const part of this.parts) this.drawCursor(part);
  }

  draw() {
    if (!this.colours) return;
    for (const part of this.parts) this.drawPart(part);
  }

  drawPart(part) {
    const { curve, canvas, height } = part;
    const width = canvas.clientWidth || canvas.parentElement.clientWidth;
    const ratio = window.devicePixelRatio || 1;
    Object.assign(part, { width, ratio });
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    canvas.style.height = `${height}px`;
    part.still = document.createElement("canvas");
    part.still.width = canvas.width;
    part.still.height = canvas.height;
    const pen = part.still.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.font = "11px system-ui, sans-serif";
    part.x = (t) => LEFT + ((t - this.low) / (this.high - this.low)) * (width - LEFT - RIGHT);
    this.drawTime(pen, part.x, height);
    if (curve.rows) this.drawRows(pen, curve, part.x);
    else this.drawLines(pen, curve, part.x, height);
    this.drawCursor(part);
  }

  drawCursor({ curve, canvas, said, height, width, ratio, still, x }) {
    if (!still || !still.width) return;
    const pen = canvas.getContext("2d");
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(still, 0, 0);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.strokeStyle = this.colours.ink;
    pen.lineWidth = 1.5;
    const at = Math.max(LEFT, Math.min(width - RIGHT, x(this.at)));
    pen.beginPath();
    pen.moveTo(at, 2);
    pen.lineTo(at, height - 14);
    pen.stroke();
    said.textContent = curve.rows ? this.bandsNow(curve) : this.valuesNow(curve);
  }

  valuesNow(curve) {
    const found = curve.lines.map((line) => [line, this.valueAt(line)]).filter(([, value]) => value !== null);
    return found.map(([line, value]) => (line.id ? `${line.id}: ${value.toFixed(1)}` : value.toFixed(0))).join("  ");
  }

  bandsNow(curve) {
    const here = ([start, end]) => start <= this.at && this.at <= end;
    const found = curve.rows.map((row) => [row.id, row.bands.find(here)]).filter(([, band]) => band);
    return found.map(([id, band]) => `${id}: ${band[2].replaceAll("_", " ")}`).join("  ");
  }

  drawTime(pen, x, height) {
    pen.fillStyle = this.colours.faint;
    pen.strokeStyle = this.colours.grid;
    pen.lineWidth = 1;
    pen.textAlign = "center";
    pen.textBaseline = "bottom";
    for (const t of ticks(this.low, this.high, 8)) {
      pen.beginPath();
      pen.moveTo(x(t), 0);
      pen.lineTo(x(t), height - 14);
      pen.stroke();
      pen.fillText(`${t} s`, x(t), height);
    }
  }

  drawLines(pen, curve, x, height) {
    let high = Math.max(...curve.levels.map((level) => level.value * 1.1), 1);
    for (const line of curve.lines) for (const value of line.y) if (value > high) high = value;
    const y = (value) => (height - 16) * (1 - value / (high * 1.05)) + 2;
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (const value of ticks(0, high, 3)) {
      pen.fillStyle = this.colours.faint;
      pen.fillText(String(value), LEFT - 4, y(value));
    }
    let named = Infinity;
    for (const level of [...curve.levels].sort((a, b) => a.value - b.value)) {
      pen.setLineDash([4, 3]);
      pen.strokeStyle = this.colours.safety;
      pen.beginPath();
      pen.moveTo(LEFT, y(level.value));
      pen.lineTo(x(this.high), y(level.value));
      pen.stroke();
      pen.setLineDash([]);
      pen.textAlign = "left";
      const beside = named - y(level.value) < 11 ? 16 : 0; // two names at one height stand beside each other
      pen.fillText(level.name, LEFT + 3 + beside, y(level.value) - 6);
      named = beside ? Infinity : y(level.value);
    }
    for (const line of curve.lines) {
      pen.strokeStyle = line.id ? this.colours.vehicle(line.id, line.role === "evader") : this.colours.free;
      pen.lineWidth = 1.6;
      pen.beginPath();
      line.t.forEach((t, i) => (i ? pen.lineTo(x(t), y(line.y[i])) : pen.moveTo(x(t), y(line.y[i]))));
      pen.stroke();
    }
  }

  valueAt(line) {
    const { t, y } = line;
    if (this.at < t[0] || this.at > t[t.length - 1]) return null;
    let [low, i] = [0, t.length - 1];
    while (low < i) {
      const middle = (low + i) >> 1;
      if (t[middle] < this.at) low = middle + 1;
      else i = middle;
    }
    i = Math.max(1, i);
    const share = (this.at - t[i - 1]) / Math.max(1e-9, t[i] - t[i - 1]);
    return y[i - 1] + share * (y[i] - y[i - 1]);
  }

  drawRows(pen, curve, x) {
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    curve.rows.forEach((row, i) => {
      pen.fillStyle = this.colours.faint;
      pen.fillText(String(row.id), LEFT - 4, ROW * i + ROW / 2 + 1);
      for (const [start, end, rule] of row.bands) {
        pen.fillStyle = this.colours.rule(rule);
        const band = [x(start), ROW * i + 2, Math.max(1, x(end) - x(start)), ROW - 4];
        pen.fillRect(...band);
        pen.strokeStyle = this.colours.faint;
        pen.lineWidth = 1;
        pen.strokeRect(...band);
      }
    });
  }
}
