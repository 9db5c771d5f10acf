// Vehicles and tracks: instanced meshes, whatever their number; their trails.
import {
  BufferAttribute, BufferGeometry, ConeGeometry, DynamicDrawUsage, Group, InstancedMesh, LineBasicMaterial,
  LineSegments, MeshBasicMaterial, MeshLambertMaterial, Object3D, SphereGeometry, BoxGeometry, CylinderGeometry,
} from "three";
import { isEvader, knowEvaders } from "colours";
import { tint } from "paint";
import { Trails } from "trails";

const SIGMAS = 2; // of the ellipsoids of tracks

// A body that points north (−z) and is one metre long.
function body(kind) {
  if (kind === "evader") {
    const geometry = new CylinderGeometry(0, 0.42, 1, 4);
    geometry.rotateX(-Math.PI / 2);
    return geometry;
  }
  if (kind === "tracker") return new BoxGeometry(0.6, 0.3, 0.6);
  const geometry = new ConeGeometry(0.3, 1, 12);
  geometry.rotateX(-Math.PI / 2);
  return geometry;
}

export class Fleet {
  constructor() {
    this.group = new Group();
    this.meshes = {};
    this.capacity = 0;
    this.trails = new Trails();
    this.group.add(this.trails.lines);
    this.vehicles = [];
    this.out = new Set(); // ids of evaders that are out of the game
    this.tracks = [];
    this.one = new Object3D();
    this.one.rotation.order = "YXZ";
    this.expected = []; // ids of evaders, by the setup
    this.grow(16);
  }

  grow(capacity) {
    for (const mesh of Object.values(this.meshes)) {
      this.group.remove(mesh);
      mesh.dispose();
    }
    this.capacity = capacity;
    for (const kind of ["evader", "pursuer", "tracker"]) {
      const mesh = new InstancedMesh(body(kind), new MeshLambertMaterial({ color: 0xffffff }), capacity);
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      mesh.frustumCulled = false;
      mesh.count = 0;
      this.meshes[kind] = mesh;
      this.group.add(mesh);
    }
    const ellipsoid = new SphereGeometry(1, 20, 12);
    const veil = new MeshBasicMaterial({ transparent: true, opacity: 0.22, depthWrite: false });
    this.meshes.track = new InstancedMesh(ellipsoid, veil, capacity);
    this.meshes.track.frustumCulled = false;
    this.meshes.track.count = 0;
    this.group.add(this.meshes.track);
    if (this.drops) {
      this.group.remove(this.drops);
      this.drops.geometry.dispose();
    }
    const feet = new BufferGeometry();
    feet.setAttribute("position", new BufferAttribute(new Float32Array(capacity * 6), 3).setUsage(DynamicDrawUsage));
    this.drops = new LineSegments(feet, new LineBasicMaterial({ transparent: true, opacity: 0.45 }));
    this.drops.frustumCulled = false;
    this.group.add(this.drops);
  }

  // From each vehicle straight down to the ground, so that heights can be read.
  showDrops(vehicles) {
    const { position } = this.drops.geometry.attributes;
    vehicles.slice(0, this.capacity).forEach((v, i) => position.array.set([v.x, v.y, v.z, v.x, 0, v.z], 6 * i));
    this.drops.geometry.setDrawRange(0, 2 * Math.min(vehicles.length, this.capacity));
    this.drops.material.color.set(this.colours.faint);
    position.needsUpdate = true;
  }

  setColours(colours) {
    this.colours = colours;
    this.trails.setColour((key) => tint(this.colourOf(key)));
    if (this.vehicles.length) this.show(this.vehicles, this.tracks, this.scale, this.roles);
  }

  colourOf(key) {
    const id = Number(key.slice(1));
    if (key[0] === "t") return this.colours.faint;
    return this.colours.vehicle(id, isEvader(id));
  }

  // Show these; `scale(x, y, z)` is the size of a body there [m].
  show(vehicles, tracks, scale, roles) {
    Object.assign(this, { vehicles, tracks, scale, roles });
    const need = Math.max(vehicles.length + tracks.length, tracks.length);
    if (need > this.capacity) this.grow(Math.max(need, 2 * this.capacity));
    const counts = { evader: 0, pursuer: 0, tracker: 0 };
    const evaders = [...vehicles.filter((v) => roles[v.role] === "evader").map((v) => v.id), ...this.expected];
    if (knowEvaders(new Set(evaders))) this.trails.setColour(this.trails.colour);
    for (const v of vehicles) {
      const kind = counts[roles[v.role]] === undefined ? "pursuer" : roles[v.role];
      const mesh = this.meshes[kind];
      this.one.position.set(v.x, v.y, v.z);
      this.one.rotation.set(v.pitch, -v.yaw, -v.roll);
      this.one.scale.setScalar(scale(v.x, v.y, v.z));
      this.one.updateMatrix();
      mesh.setMatrixAt(counts[kind], this.one.matrix);
      mesh.setColorAt(counts[kind], tint(v.fed && !this.out.has(v.id) ? this.colours.vehicle(v.id, kind === "evader") : this.colours.faint));
      counts[kind] += 1;
    }
    for (const kind of Object.keys(counts)) {
      const mesh = this.meshes[kind];
      mesh.count = counts[kind];
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    this.showTracks(tracks, scale);
    this.showDrops(vehicles);
  }

  showTracks(tracks, scale) {
    const mesh = this.meshes.track;
    tracks.forEach((t, i) => {
      const least = 0.25 * scale(t.x, t.y, t.z);
      this.one.position.set(t.x, t.y, t.z);
      this.one.rotation.set(0, 0, 0);
      const radius = (sigma) => Math.max(Number.isFinite(sigma) ? SIGMAS * sigma : least, least);
      this.one.scale.set(radius(t.sx), radius(t.sy), radius(t.sz));
      this.one.updateMatrix();
      mesh.setMatrixAt(i, this.one.matrix);
      mesh.setColorAt(i, tint(this.colours.vehicle(t.id, true)));
    });
    mesh.count = tracks.length;
    mesh.instanceMatrix.needsUpdate = true;
    if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
  }
}
