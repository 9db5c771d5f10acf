// What the page uses of three.js; esbuild leaves the rest out.
export {
  AmbientLight, BoxGeometry, BufferAttribute, BufferGeometry, CanvasTexture, Color, ConeGeometry, CylinderGeometry,
  DataTexture, DirectionalLight, DoubleSide, DynamicDrawUsage, EdgesGeometry, Float32BufferAttribute, FrontSide, GridHelper, Group,
  InstancedBufferAttribute, InstancedMesh, Line, LineBasicMaterial, LineDashedMaterial, LineLoop, LineSegments, Matrix4,
  Mesh, MeshBasicMaterial, MeshLambertMaterial, Object3D, OrthographicCamera, PerspectiveCamera, Plane, PlaneGeometry,
  Points, PointsMaterial, Quaternion, Raycaster, RingGeometry, Scene, SphereGeometry, Sprite, SpriteMaterial, Texture,
  MOUSE, TOUCH, TextureLoader, Vector2, Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
export { MapControls } from "three/examples/jsm/controls/MapControls.js";
