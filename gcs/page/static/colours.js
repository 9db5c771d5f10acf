// The palette of console, report and pictures, for paper and for a dark screen.

const ranks = new Map(); // of each evader's id among the evaders': which of their shades it has

// Which vehicles are evaders; true where that is news.
export function knowEvaders(ids) {
  const sorted = [...ids].sort((a, b) => a - b);
  if (sorted.length === ranks.size && sorted.every((id, rank) => ranks.get(id) === rank)) return false;
  ranks.clear();
  sorted.forEach((id, rank) => ranks.set(id, rank));
  return true;
}

export const isEvader = (id) => (ranks.size ? ranks.has(id) : id === 1);
export const severalEvaders = () => ranks.size > 1;

export function colours(palette, dark) {
  const shade = (pair) => pair[dark ? 1 : 0];
  return {
    dark,
    ink: shade(palette.ink), faint: shade(palette.faint), paper: shade(palette.paper), grid: shade(palette.grid),
    target: shade(palette.target), capture: shade(palette.capture),
    safety: shade(palette.safety), fence: shade(palette.fence), zone: shade(palette.zone), force: shade(palette.force), apollonius: shade(palette.apollonius),
    cone: shade(palette.cone), free: shade(palette.pursuers[1]),
    vehicle: (id, evader) =>
      shade(evader ? palette.evaders[(ranks.get(id) || 0) % palette.evaders.length] : palette.pursuers[(((id - 2) % palette.pursuers.length) + palette.pursuers.length) % palette.pursuers.length]),
    rule: (name) => palette.rules[name] || palette.other_rules[[...name].reduce((n, c) => (n * 31 + c.charCodeAt(0)) >>> 0, 7) % palette.other_rules.length],
    action: (name) => shade(palette.actions[name] || palette.actions.end),
  };
}
