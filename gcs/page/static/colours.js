// The palette of console, report and pictures, for paper and for a dark screen.

export function colours(palette, dark) {
  const shade = (pair) => pair[dark ? 1 : 0];
  return {
    dark,
    ink: shade(palette.ink), faint: shade(palette.faint), paper: shade(palette.paper), grid: shade(palette.grid),
    evader: shade(palette.evader), target: shade(palette.target), capture: shade(palette.capture),
    safety: shade(palette.safety), fence: shade(palette.fence), apollonius: shade(palette.apollonius),
    cone: shade(palette.cone), free: shade(palette.pursuers[1]),
    vehicle: (id, evader) =>
      shade(evader ? palette.evader : palette.pursuers[(((id - 2) % palette.pursuers.length) + palette.pursuers.length) % palette.pursuers.length]),
    rule: (name) => palette.rules[name] || palette.other_rules[[...name].reduce((n, c) => (n * 31 + c.charCodeAt(0)) >>> 0, 7) % palette.other_rules.length],
    action: (name) => shade(palette.actions[name] || palette.actions.end),
  };
}
