// The table of vehicles: sorted by any column, filtered, many selected; plain HTML.

export class VehicleTable {
  // `on.choose(ids, first)`: which are marked, and which one was named last.
  constructor(table, filter, on) {
    this.table = table;
    this.filter = filter;
    this.on = on;
    this.sort = "id";
    this.descending = false;
    this.marked = new Set();
    this.last = null;
    this.rows = [];
    filter.addEventListener("input", () => this.draw());
  }

  setColumns(columns, grades) {
    this.columns = columns;
    this.grades = grades;
    const head = document.createElement("tr");
    columns.forEach((column) => {
      const cell = document.createElement("th");
      cell.title = column.help;
      cell.className = `column-${column.name.replace(/\W+/g, "-")}`;
      if (column.sort) {
        const button = document.createElement("button");
        button.textContent = column.label;
        button.dataset.sort = column.sort;
        button.addEventListener("click", () => this.sortBy(column.sort));
        cell.append(button);
      } else {
        const name = document.createElement("span");
        name.textContent = column.label;
        cell.append(name);
      }
      head.append(cell);
    });
    this.body = document.createElement("tbody");
    const top = document.createElement("thead");
    top.append(head);
    this.table.replaceChildren(top, this.body);
    this.lines = new Map();
  }

  sortBy(name) {
    this.descending = name === this.sort ? !this.descending : false;
    this.sort = name;
    this.draw();
  }

  setRows(rows, colours) {
    this.rows = rows;
    this.colours = colours;
    for (const id of [...this.marked]) if (!rows.some((row) => row.id === id)) this.marked.delete(id);
    this.draw();
  }

  // The rows shown, in order; unknown values last either way.
  ordered() {
    const words = this.filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const shown = this.rows.filter((row) => {
      const text = `${row.cells.join(" ")} ${row.role}`.toLowerCase();
      return words.every((word) => text.includes(word));
    });
    const sign = this.descending ? -1 : 1;
    return shown.sort((a, b) => {
      const [x, y] = [a.keys[this.sort], b.keys[this.sort]];
      if (x === null || y === null) return (x === null) - (y === null) || a.id - b.id;
      return x === y ? a.id - b.id : sign * (x < y ? -1 : 1);
    });
  }

  draw() {
    if (!this.body) return;
    for (const button of this.table.querySelectorAll("th button")) {
      const own = button.dataset.sort === this.sort;
      button.parentElement.setAttribute("aria-sort", own ? (this.descending ? "descending" : "ascending") : "none");
      const name = this.columns.find((column) => column.sort === button.dataset.sort).label;
      button.textContent = own ? `${name}\u00a0${this.descending ? "▾" : "▴"}` : name;
    }
    const wanted = this.ordered().map((row) => this.line(row));
    if (wanted.length !== this.body.children.length || wanted.some((line, i) => line !== this.body.children[i])) {
      this.body.replaceChildren(...wanted);
    }
  }

  line(row) {
    let line = this.lines.get(row.id);
    if (!line) {
      line = document.createElement("tr");
      line.tabIndex = 0;
      line.dataset.id = row.id;
      row.cells.forEach((_, i) => {
        const cell = document.createElement("td");
        cell.className = `column-${this.columns[i].name.replace(/\W+/g, "-")}`;
        line.append(cell);
      });
      line.addEventListener("click", (event) => this.choose(row.id, event));
      line.addEventListener("keydown", (event) => {
        if (event.key === "Enter" || event.key === " ") {
          event.preventDefault();
          this.choose(row.id, event);
        }
      });
      this.lines.set(row.id, line);
    }
    row.cells.forEach((text, i) => {
      const cell = line.children[i];
      if (cell.dataset.text !== text) {
        cell.dataset.text = text;
        cell.textContent = text;
        if (i === 0) cell.prepend(document.createElement("span"));
        if (this.columns[i].name === "health") cell.className = `column-health grade-${text}`;
      }
    });
    if (this.colours) {
      const swatch = line.querySelector("span");
      const shade = this.colours.vehicle(row.id, row.role === "evader");
      if (swatch.dataset.shade !== `${row.role} ${shade}`) {
        swatch.dataset.shade = `${row.role} ${shade}`; // of another theme, or of more evaders
        swatch.className = `swatch ${row.role}`;
        swatch.style.background = shade;
      }
    }
    line.classList.toggle("chosen", this.marked.has(row.id));
    line.setAttribute("aria-selected", this.marked.has(row.id));
    return line;
  }

  // Click: this one alone; with ctrl: also; with shift: all between.
  choose(id, event = {}) {
    const ids = this.ordered().map((row) => row.id);
    if (event.shiftKey && this.last !== null) {
      const [a, b] = [ids.indexOf(this.last), ids.indexOf(id)].sort((x, y) => x - y);
      ids.slice(Math.max(0, a), b + 1).forEach((each) => this.marked.add(each));
    } else if (event.ctrlKey || event.metaKey) {
      if (this.marked.has(id)) this.marked.delete(id);
      else this.marked.add(id);
      this.last = id;
    } else {
      this.marked = new Set([id]);
      this.last = id;
    }
    this.draw();
    this.on.choose([...this.marked].sort((a, b) => a - b), id);
  }

  // The next one up or down.
  move(step) {
    const ids = this.ordered().map((row) => row.id);
    if (!ids.length) return;
    const at = ids.indexOf(this.last);
    const next = ids[Math.max(0, Math.min(ids.length - 1, at < 0 ? 0 : at + step))];
    this.choose(next);
    this.lines.get(next).scrollIntoView({ block: "nearest" });
  }
}
