// Reads what moves: the flat array of gcs/page/frames.py. Places come out as three.js has them: east, up, south.

export function reader(layout) {
  const width = layout.vehicle.length;
  const at = Object.fromEntries(layout.vehicle.map((name, i) => [name, i]));
  const of = Object.fromEntries(layout.track.map((name, i) => [name, i]));
  return (buffer) => {
    const head = new DataView(buffer);
    const count = head.getUint16(8, true);
    const tracked = head.getUint16(10, true);
    const rows = new Float32Array(buffer, layout.head);
    const vehicles = [];
    for (let i = 0; i < count; i += 1) {
      const r = i * width;
      vehicles.push({
        id: rows[r + at.id], role: rows[r + at.role], grade: rows[r + at.grade], fed: rows[r + at.fed] > 0.5,
        x: rows[r + at.east], y: -rows[r + at.down], z: -rows[r + at.north],
        vx: rows[r + at.v_east], vy: -rows[r + at.v_down], vz: -rows[r + at.v_north],
        roll: rows[r + at.roll], pitch: rows[r + at.pitch], yaw: rows[r + at.yaw],
      });
    }
    const tracks = [];
    for (let i = 0; i < tracked; i += 1) {
      const r = (count + i) * width;
      tracks.push({
        id: rows[r + of.id], age: rows[r + of.age],
        x: rows[r + of.east], y: -rows[r + of.down], z: -rows[r + of.north],
        vx: rows[r + of.v_east], vy: -rows[r + of.v_down], vz: -rows[r + of.v_north],
        sx: rows[r + of.sigma_east], sy: rows[r + of.sigma_down], sz: rows[r + of.sigma_north],
      });
    }
    return { ms: head.getFloat64(0, true), number: head.getUint32(12, true), vehicles, tracks };
  };
}

// A place (north, east, down) as three.js has it.
export function place(ned) {
  return [ned[1], -ned[2], -ned[0]];
}
