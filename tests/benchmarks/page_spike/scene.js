// The scene of both candidates: one instanced mesh, moved from one flat array a tick: x, y, z, heading of each.
export function scene(THREE, host) {
  const renderer = new THREE.WebGLRenderer({ antialias: false });
  renderer.setSize(1280, 700);
  host.appendChild(renderer.domElement);
  const camera = new THREE.PerspectiveCamera(50, 1280 / 700, 1, 20000);
  camera.position.set(0, 900, 1600);
  camera.lookAt(0, 0, 0);
  const world = new THREE.Scene();
  world.add(new THREE.GridHelper(3000, 30));
  const cone = new THREE.ConeGeometry(8, 24, 6);
  cone.rotateX(Math.PI / 2);
  const mesh = new THREE.InstancedMesh(cone, new THREE.MeshBasicMaterial({ color: 0x1f77b4 }), 2000);
  mesh.frustumCulled = false;
  world.add(mesh);
  const one = new THREE.Object3D();
  const seen = { drawn: 0, delays: [] };
  let fresh = false;
  let sent = 0;
  function frame() {
    requestAnimationFrame(frame);
    if (!fresh) return;
    fresh = false;
    renderer.render(world, camera);
    seen.drawn += 1;
    seen.delays.push(Date.now() - sent);
  }
  requestAnimationFrame(frame);
  window.seen = seen;
  return (stamp, floats) => {
    const count = floats.length / 4;
    for (let i = 0; i < count; i += 1) {
      one.position.set(floats[4 * i], floats[4 * i + 1], floats[4 * i + 2]);
      one.rotation.set(0, floats[4 * i + 3], 0);
      one.updateMatrix();
      mesh.setMatrixAt(i, one.matrix);
    }
    mesh.count = count;
    mesh.instanceMatrix.needsUpdate = true;
    fresh = true;
    sent = stamp;
  };
}
