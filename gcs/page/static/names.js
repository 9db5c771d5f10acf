// Names beside places of the screen, which keep off each other.

const CELL_PX = 8; // of the grid that remembers where names stand
const HALF_PX = 6; // of a name's height
const WIDTHS_MOST = 4096; // remembered

export class Names {
  constructor() {
    this.taken = new Set();
    this.widths = new Map(); // [px]
  }

  clear() {
    this.taken.clear();
    if (this.widths.size > WIDTHS_MOST) this.widths.clear();
  }

  // Where a name can begin, its middle's height: right above the place, right below, left above, left below; `away`
  // [px] from it. `must`: right above where there is no room at all; else on the right or nowhere (null).
  put(pen, text, [x, y], { away = 12, must = true } = {}) {
    if (!this.widths.has(text)) this.widths.set(text, pen.measureText(text).width);
    const width = this.widths.get(text);
    const right = [[x + away, y - 10], [x + away, y + 13]];
    const ways = must ? [...right, [x - away - width, y - 10], [x - away - width, y + 13]] : right;
    const found = ways.find((at) => this.cells(at, width).every((cell) => !this.taken.has(cell))) || (must ? ways[0] : null);
    if (found) this.cells(found, width).forEach((cell) => this.taken.add(cell));
    return found;
  }

  cells([x, y], width) {
    const found = [];
    for (let i = Math.floor(x / CELL_PX); i <= Math.floor((x + width) / CELL_PX); i += 1) {
      for (let j = Math.floor((y - HALF_PX) / CELL_PX); j < Math.ceil((y + HALF_PX) / CELL_PX); j += 1) found.push(i * 4096 + j);
    }
    return found;
  }
}
