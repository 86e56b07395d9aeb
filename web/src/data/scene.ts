// Bodies, cords, meshes, light and camera of a run (src/page/scene_data.h).
import type { Camera, Environment, LightTexels, Mesh, MeshPaint, MeshTexture, Scene, Texels, Vec3 } from "./clip.ts";
import type { Container, PredictedReference } from "./container.ts";
import type { EnvironmentHeader, LightHeader, MeshHeader, PaintHeader, RunHeader, TexelsHeader, TextureHeader } from "./header.ts";

type Reader = Container<unknown>;

export function read_mesh(header: MeshHeader, reader: Reader): Mesh {
  const places = header.positions.map((part) => reader.predicted(part));
  const directions = header.normals.map((part) => reader.predicted(part));
  const count = places[0].length;
  const mesh: Mesh = {
    positions: new Float32Array(3 * count),
    normals: new Float32Array(3 * count),
    indices: Uint32Array.from(reader.predicted(header.indices)),
  };
  for (let i = 0; i < count; ++i) {
    const length = Math.hypot(directions[0][i], directions[1][i], directions[2][i]) || 1;
    for (let c = 0; c < 3; ++c) {
      mesh.positions[3 * i + c] = header.min[c] + header.quantum * places[c][i];
      mesh.normals[3 * i + c] = directions[c][i] / length;
    }
  }
  if (header.paint) mesh.paint = read_paint(header.paint, reader);
  return mesh;
}

/** Columns as an array of items with one number of each. */
function interleaved(columns: PredictedReference[], reader: Reader, value: (whole: number) => number): Float32Array {
  const whole = columns.map((part) => reader.predicted(part));
  return Float32Array.from({ length: whole.length * whole[0].length }, (_, i) =>
    value(whole[i % whole.length][Math.floor(i / whole.length)]));
}

export function read_texels({ width, height, channels }: TexelsHeader, reader: Reader): Texels {
  const texels = new Uint8Array(4 * width * height).fill(255);
  channels.forEach((part, c) => reader.predicted(part).forEach((value, i) => (texels[4 * i + c] = value)));
  return { width, height, texels };
}

function read_light(header: LightHeader, reader: Reader): LightTexels {
  const { width, height, channels, most, steps } = header;
  const light = new Float32Array(4 * width * height).fill(1);
  channels.forEach((part, c) =>
    reader.predicted(part).forEach((value, i) => (light[4 * i + c] = (value / steps) ** 2 * most)));
  return { width, height, light };
}

function read_environment(header: EnvironmentHeader | undefined, reader: Reader): Environment | null {
  if (!header) return null;
  const { mirror, image, ...values } = header;
  return {
    ...values,
    ...(mirror && { mirror: read_light(mirror, reader) }),
    ...(image && { image: read_light(image, reader) }),
  };
}

function read_texture(header: TextureHeader, reader: Reader): MeshTexture {
  const { wrap, nearest, cutoff, opacity } = header;
  const map = (texels: TexelsHeader | undefined) => texels && read_texels(texels, reader);
  return {
    ...read_texels(header, reader), wrap, nearest, cutoff, opacity, normal_map: map(header.normal_map),
    surface_map: map(header.surface_map), emission_map: map(header.emission_map),
  };
}

function read_paint(header: PaintHeader, reader: Reader): MeshPaint {
  const squared = (columns: PredictedReference[]) => interleaved(columns, reader, (value) => (value / header.color_steps) ** 2);
  return {
    uv: interleaved(header.uv, reader, (value) => value / header.uv_steps),
    color: squared(header.color),
    emission: squared(header.emission),
    surface: interleaved(header.surface, reader, (value) => value / header.color_steps),
    groups: header.groups.map(({ first, count, texture }) => ({ first, count, texture: texture && read_texture(texture, reader) })),
  };
}

/** The camera at any time: cubic between frames, with the slopes of their neighbors. */
function read_camera(run: RunHeader, reader: Reader): (time: number) => Camera {
  const { eye, target, up, vertical_fov, quantum, frames } = run.camera;
  if (frames === undefined || quantum === undefined) return () => ({ eye, target, up, vertical_fov });
  const columns = frames.map((part) => reader.predicted(part).map((value) => quantum * value));
  const last = run.frames - 1;
  const value = (column: Float64Array, n: number, u: number): number => {
    if (n >= last) return column[last];
    const way = column[n + 1] - column[n];
    const slope = n > 0 ? 0.5 * (column[n + 1] - column[n - 1]) : way;
    const next = n + 1 < last ? 0.5 * (column[n + 2] - column[n]) : way;
    return column[n] + u * u * (3 - 2 * u) * way + u * (1 - u) * ((1 - u) * slope - u * next);
  };
  return (time) => {
    const at = Math.min(Math.max(time * run.fps, 0), last), n = Math.floor(at + 1e-9), u = Math.max(0, at - n);
    const values = columns.map((column) => value(column, n, u));
    return {
      eye: values.slice(0, 3) as Vec3,
      target: values.slice(3, 6) as Vec3,
      up: values.slice(6, 9) as Vec3,
      vertical_fov: values[9],
    };
  };
}

export function read_scene(run: RunHeader, reader: Reader, meshes: Mesh[], textures: Texels[]): Scene {
  return {
    bodies: run.bodies,
    cords: run.cords,
    meshes,
    textures,
    light: run.light,
    environment: read_environment(run.environment, reader),
    water: run.water ?? null,
    exposure: run.exposure ?? 0,
    tone: run.tone ?? "filmic",
    camera_moves: run.camera.frames !== undefined,
    camera: read_camera(run, reader),
  };
}
