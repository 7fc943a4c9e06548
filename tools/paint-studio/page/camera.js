// The camera of the stage, which goes around the middle of the mesh. It has the conventions of render-osmesa: +Y is up,
// azimuth 0 is +Z and grows toward +X, and pixels are counted from the upper left corner.

const added = (a, b, scale = 1) => a.map((value, i) => value + scale * b[i]);
const dotted = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const crossed = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, scale) => a.map((value) => value * scale);
const unit = (a) => scaled(a, 1 / Math.hypot(...a));

function orbitDirection(azimuth, elevation) {
  const a = (azimuth * Math.PI) / 180, e = (elevation * Math.PI) / 180;
  return [Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)];
}

// A direction as an environment sees it that was turned by these degrees about +Y, toward growing azimuths.
function turnedAgainst(v, degrees) {
  const c = Math.cos((degrees * Math.PI) / 180), s = Math.sin((degrees * Math.PI) / 180);
  return [c * v[0] - s * v[2], v[1], s * v[0] + c * v[2]];
}

// Azimuth and elevation of a direction, in degrees.
function anglesOf(direction) {
  const [x, y, z] = unit(direction);
  return { azimuth: (Math.atan2(x, z) * 180) / Math.PI, elevation: (Math.asin(Math.min(1, Math.max(-1, y))) * 180) / Math.PI };
}

// The direction from which light is mirrored to the viewer, and its angle to a direction in degrees.
const mirrored = ({ normal, wo }) => added(scaled(normal, 2 * dotted(normal, wo)), wo, -1);
function angleBetween(a, b) {
  return (Math.atan2(Math.hypot(...crossed(a, b)), dotted(a, b)) * 180) / Math.PI;
}

// {eye, target, fov} of a view {azimuth, elevation, distance, target, fov}.
function cameraOf(view) {
  return { eye: added(view.target, orbitDirection(view.azimuth, view.elevation), view.distance), target: view.target,
           fov: view.fov };
}

// The camera for a picture of another shape: one that is narrower than 16:9 shows as much of the width.
function widened(camera, aspect) {
  const tangent = Math.tan((camera.fov * Math.PI) / 360) * Math.max(1, 16 / 9 / aspect);
  return { ...camera, fov: (Math.atan(tangent) * 360) / Math.PI };
}

// The rays through the pixels of a picture, and the matrix that takes the mesh there, with y down. `shift` moves the
// point of every pixel that is sampled.
function projected(camera, width, height, box, shift) {
  const forward = unit(added(camera.target, camera.eye, -1));
  const right = unit(crossed(forward, [0, 1, 0])), down = crossed(forward, right);
  const pixel = (2 * Math.tan((0.5 * camera.fov * Math.PI) / 180)) / height;
  let corner = added(added(forward, right, -0.5 * width * pixel), down, -0.5 * height * pixel);
  corner = added(added(corner, right, shift[0] * pixel), down, shift[1] * pixel);
  let nearest = Infinity, farthest = 0;
  for (let c = 0; c < 8; ++c) {
    const point = [0, 1, 2].map((axis) => (c & (1 << axis) ? box.high[axis] : box.low[axis]));
    const depth = dotted(added(point, camera.eye, -1), forward);
    nearest = Math.min(nearest, depth);
    farthest = Math.max(farthest, depth);
  }
  const size = Math.hypot(...added(box.high, box.low, -1));
  const far = Math.max(1.001 * farthest, 1e-3 * size), near = Math.max(0.999 * nearest, 1e-4 * far);
  const x = added(scaled(right, 2 / (width * pixel)), forward, (-2 * shift[0]) / width);
  const y = added(scaled(down, 2 / (height * pixel)), forward, (-2 * shift[1]) / height);
  const z = scaled(forward, (far + near) / (far - near)), e = camera.eye;
  const clip = [0, 1, 2].flatMap((axis) => [x[axis], y[axis], z[axis], forward[axis]]);
  clip.push(-dotted(x, e), -dotted(y, e), -dotted(z, e) - (2 * far * near) / (far - near), -dotted(forward, e));
  return { corner, right: scaled(right, pixel), down: scaled(down, pixel), clip: new Float32Array(clip), reach: 1 / far };
}

// Where the samples of a pixel lie: the first in its middle, and all of them, and the first four, evenly in a disk of its area.
const mostSamples = 16, sampleShifts = Array.from({ length: mostSamples }, (_, i) => {
  const k = (7 * i) % mostSamples, radius = Math.sqrt(k / mostSamples / Math.PI), angle = Math.PI * (3 - Math.sqrt(5)) * k;
  return [radius * Math.cos(angle), radius * Math.sin(angle)];
});
