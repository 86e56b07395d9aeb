// A clip as the player sees it: one or several runs of a scene, ready to be asked for any moment. SI units, world frame,
// y up, unless said otherwise. `decode_clip()` makes it from the data of a page; the player knows nothing of its layout.
import type { EnvironmentHeader, TextureHeader } from "./header.ts";
import overlay_style from "../../../src/overlay/overlay_style.json";

export type Vec3 = [number, number, number];
/** w, x, y, z; unit. */
export type Quat = [number, number, number, number];
/** Rows, one after the other. */
export type Mat3 = [number, number, number, number, number, number, number, number, number];
/** sRGB, "#rrggbb". */
export type ColorText = string;

export interface Clip {
  title: string;
  /** Name and version of the program. */
  generator: string;
  /** Texts that the clip was made from: the scene file, or a block of a lesson. */
  sources: { name: string; text: string }[];
  /** At least one; several come from `--vary` or from several scenes. */
  runs: Run[];
}

export interface Run {
  /** Tells it from the other runs: "restitution 0.5". Empty if it is the only one. */
  label: string;
  /** Seconds; the last frame's time. */
  duration: number;
  fps: number;
  /** Frame n shows n / fps. */
  frames: number;
  /** Times of the frames of a clip whose speed changes, by fps; empty: the speed is 1. */
  pace: number[];
  settings: RunSettings;
  scene: Scene;
  motion: Motion;
  energy: EnergyTable;
  /** Quantities of joints by frame, by their names in `--plot`: "joint.hinge.force". Those of the scene's plots only. */
  joints: Map<string, Float64Array>;
  /** In order of time; of too many, the strongest. */
  impacts: Impact[];
  /** How many there were in the run. */
  all_impacts: number;
  /** Of too many in a frame, those with the largest forces. */
  contacts: ContactTable;
  /** How many rows there were in all frames. */
  all_contacts: number;
  loads: LoadTable;
  /** Empty where there are too many joints and frames. */
  joint_marks: JointMarks[];
  cracks: CrackMarks[];
  overlays: OverlaySettings;
}

export interface RunSettings {
  impacts: "exact" | "stepped";
  /** "tumble", or "notes": the course notes to the letter. */
  method: string;
  integrator: string;
  /** Step in s. */
  step: number;
  gravity: Vec3;
}

export interface Scene {
  /** In scene order, fixed ones included. */
  bodies: Body[];
  cords: Cord[];
  /** Triangle meshes that shapes name by index. */
  meshes: Mesh[];
  /** Images that bodies name by index. */
  textures: Texels[];
  light: Light;
  environment: Environment | null;
  water: Water | null;
  /** Stops. */
  exposure: number;
  tone: "filmic" | "linear";
  /** Whether the camera moves by itself: keyframes, an orbit or a followed body. */
  camera_moves: boolean;
  camera(time: number): Camera;
}

/** Its surface is level + sum of amplitude cos(k . (x, z) - rate t + phase). */
export interface Water {
  /** m. */
  level: number;
  color: string;
  waves: {
    /** 1/m, along x and z. */
    k: [number, number];
    /** m. */
    amplitude: number;
    /** rad/s. */
    rate: number;
    phase: number;
  }[];
}

/** Light and background of an image or colors, linear. */
export interface Environment extends Omit<EnvironmentHeader, "mirror" | "image"> {
  mirror?: LightTexels;
  image?: LightTexels;
}

export interface LightTexels {
  width: number;
  height: number;
  /** Four numbers a texel, rows from the top. */
  light: Float32Array;
}

export interface Camera {
  eye: Vec3;
  target: Vec3;
  up: Vec3;
  /** Degrees. */
  vertical_fov: number;
}

export interface Mesh {
  /** Three numbers a vertex, m, in the frame of the shape. */
  positions: Float32Array;
  normals: Float32Array;
  indices: Uint32Array;
  paint?: MeshPaint;
}

/** The colors of a mesh's file. */
export interface MeshPaint {
  /** Two numbers a vertex, from the top left corner of the texture. */
  uv: Float32Array;
  /** Three numbers a vertex, linear. */
  color: Float32Array;
  emission: Float32Array;
  /** Roughness and metallic of each vertex; below 0: the body's. */
  surface: Float32Array;
  groups: { first: number; count: number; texture: MeshTexture | null }[];
}

export interface Texels {
  width: number;
  height: number;
  /** Four bytes a texel, rows from the top: square roots of linear light, and alpha. */
  texels: Uint8Array;
}

/** The sun, and what several lights have in addition. */
export interface Light {
  direction: Vec3;
  shadows: boolean;
  /** Of the sun, linear; only with several lights. */
  color?: Vec3;
  /** See shaders/lights.glsl; in the world, with the kind and the cosine of half the cone's angle. */
  others?: { kind: number; place: Vec3; light: Vec3; axis: Vec3; cosine: number }[];
}

export interface MeshTexture extends Texels {
  wrap: TextureHeader["wrap"];
  nearest: boolean;
  /** Texels with less alpha are holes. */
  cutoff: number;
  /** See shaders/surface_maps.glsl; texels are numbers, of the emission square roots. */
  normal_map?: Texels;
  surface_map?: Texels;
  emission_map?: Texels;
  /** Only of translucent materials, whose alpha multiplies it. */
  opacity?: number;
}

/** In the body's frame, from the body's origin. */
export type Shape =
  | { type: "plane"; normal: Vec3; offset: number }
  | { type: "box"; size: Vec3 }
  | { type: "sphere"; radius: number }
  | { type: "mesh"; mesh: number }
  | { type: "compound"; parts: { shape: Shape; position: Vec3; rotation: Quat; color: ColorText; pattern_color?: ColorText }[] };

export interface Body {
  /** The scene's name for it, or its index. */
  name: string;
  type: "dynamic" | "fixed" | "kinematic";
  shape: Shape;
  color: ColorText;
  /** 0 mirror to 1 chalk. */
  roughness: number;
  metallic: number;
  pattern: "panel" | "grid" | "checker" | "plain" | "stripes" | "dots" | "noise" | "wood" | "marble";
  /** Of patterns of two colors; a grid and a checker without it only darken. */
  pattern_color?: ColorText;
  /** m, of a cell; by default by the size of the shape. */
  pattern_scale?: number;
  /** Index of an image; the length in m that it covers, or 0 for a face or the way around; squares in place of blended texels. */
  texture?: { image: number | null; scale: number; nearest: boolean };
  /** Indices of images at the same places. */
  normal_map?: number;
  roughness_map?: number;
  /** Below 1. */
  opacity?: number;
  emission?: ColorText;
  visible: boolean;
  /** kg; 0 of bodies that are not dynamic: their inverse mass is zero. */
  mass: number;
  /** kg m^2, about the center of mass, body frame; zero of bodies that are not dynamic. */
  inertia: Mat3;
  /** Body frame, from the body's origin, m. */
  center_of_mass: Vec3;
  /** Null: as the other body of the pair. */
  restitution: number | null;
  friction: number | null;
}

/** A straight line to look at, without effect on the motion: from a body to a fixed point, or to another body. */
export interface Cord {
  /** Index of the body. */
  body: number;
  /** Body frame, from the body's origin, m. */
  point: Vec3;
  /** World frame, m; with an anchor_body in its frame, from its origin. */
  anchor: Vec3;
  /** Index of the body with which the anchor moves. */
  anchor_body?: number;
  /** m. */
  radius: number;
  color: ColorText;
}

/** A body at a moment. */
export interface BodyState {
  /** Of the center of mass, m. */
  position: Vec3;
  /** Of the body's own origin, where its shape is drawn, m. */
  origin: Vec3;
  rotation: Quat;
  /** Of the center of mass, m/s. */
  velocity: Vec3;
  /** rad/s. */
  angular_velocity: Vec3;
  /** kg m/s; zero of bodies that are not dynamic, as the next. */
  momentum: Vec3;
  /** About the center of mass, kg m^2/s. */
  angular_momentum: Vec3;
  asleep: boolean;
}

export interface Motion {
  /** The state at a time in [0, duration], s; times outside are clamped. At an impact's own time: the state after it. */
  state(body: number, time: number): BodyState;
  /** The state just before an impact at that time. */
  state_before(body: number, time: number): BodyState;
  /** The state just after an impact at that time. Where a step resolves the impact, before forces change it. */
  state_after(body: number, time: number): BodyState;
  /** Only position, origin and rotation: cheaper, for drawing. Writes into and returns `out`. */
  pose(body: number, time: number, out: Pose): Pose;
  /** False for a piece that has not broken off, and for a body in pieces. */
  shows(body: number, time: number): boolean;
  /** "keys": exact between keys. "frames": quantized at each frame, interpolated in between. */
  kind(body: number): "still" | "keys" | "frames";
  /** Largest deviations from the simulation at the times that it was recorded. */
  error: { position: number; rotation: number; velocity: number; angular_velocity: number };
}

export interface Pose {
  position: Vec3;
  origin: Vec3;
  rotation: Quat;
}

/** Columns by frame; the columns of `tumble simulate --energy`, J. */
export interface EnergyTable {
  kinetic_linear: Float64Array;
  kinetic_angular: Float64Array;
  potential: Float64Array;
  elastic: Float64Array;
  work: Float64Array;
  impact_loss: Float64Array;
  friction_loss: Float64Array;
  /** Touching contact points. */
  contacts: Float64Array;
  /** Deepest overlap, m. */
  max_penetration: Float64Array;
}

/** A row of `tumble simulate --impacts`, with the same names, and the poses of both bodies at its time. */
export interface Impact {
  time: number;
  exact: 0 | 1;
  frame: number;
  /** Names; `body_a` and `body_b` are their indices. */
  a: string;
  b: string;
  body_a: number;
  body_b: number;
  px: number; py: number; pz: number;
  nx: number; ny: number; nz: number;
  feature: string;
  v_before: number;
  v_after: number;
  restitution: number;
  impulse: number;
  fx: number; fy: number; fz: number;
  pass: number;
  mx: number; my: number; mz: number;
  /** Centers of mass (m) and rotations of A and B when the impulse acts. */
  pose_a: { position: Vec3; rotation: Quat };
  pose_b: { position: Vec3; rotation: Quat };
}

/** Contacts of all frames: the rows of frame n are first[n] .. first[n + 1]. */
export interface ContactTable {
  /** frames + 1 numbers. */
  first: Uint32Array;
  /** Body indices; 4294967295: nobody, a correction of the method that acts on B alone. */
  a: Uint32Array;
  b: Uint32Array;
  /** Three numbers a row. */
  point: Float32Array;
  normal: Float32Array;
  /** N. */
  normal_force: Float32Array;
  /** On B, three numbers a row, N. */
  tangential_force: Float32Array;
  /** Index into contact_states. */
  state: Uint8Array;
  /** Index into features. */
  feature: Uint8Array;
}
export const contact_states = overlay_style.contact_states.map(({ name }) => name);
export const features = overlay_style.contact_features.map(({ name }) => name);
export const nobody = 0xffffffff;

/** Gravity, wind and forces at points, on dynamic bodies: means over the frame that ends at a frame's time. */
export interface LoadTable {
  /** N. */
  force(body: number, frame: number): Vec3;
  /** About the world origin, N m. */
  moment(body: number, frame: number): Vec3;
}

export type OverlayName =
  | "contacts" | "normals" | "impulses" | "forces" | "loads" | "velocity" | "omega" | "momentum" | "angular-momentum"
  | "trails" | "ghosts" | "aabb" | "axes" | "com" | "joints" | "islands" | "sleep" | "names" | "cracks";
export type ArrowQuantity = "force" | "impulse" | "velocity" | "omega" | "momentum" | "angular-momentum" | "torque";

/** A point of a body, from its origin in its frame, m; body -1: of the world. */
export type SketchPoint = [body: number, x: number, y: number, z: number];

/** A face between two cells of a body with `fracture`. */
export interface CrackMarks {
  whole: number;
  pieces: [number, number];
  /** Closed; m, from the origin that the three bodies share, in their frame. */
  outline: Vec3[];
}

/** What an overlay draws of a joint, and its state by frame. */
export interface JointMarks {
  name: string;
  marker: "disc" | "ring" | "square";
  anchor: SketchPoint;
  /** Surfaces nearer by less do not hide it, m. */
  allowance: number;
  /** Axes, and limits in their own color. */
  lines: { limit: boolean; points: SketchPoint[] }[];
  /** By frame: 0 holds no more, 1 holds, 2 at a limit. */
  states: ArrayLike<number>;
  /** On the second body, means over the frame, N and N m. */
  force(frame: number): Vec3;
  torque(frame: number): Vec3;
}

export interface OverlaySettings {
  /** Shown at the start. */
  show: OverlayName[];
  /** Body indices that overlays show. */
  bodies: number[];
  /** Meters in the scene for an SI unit of each quantity, found from the clip. */
  scale: Record<ArrowQuantity, number>;
  color: Record<ArrowQuantity, ColorText>;
  /** s that an impulse stays visible. */
  impulse_time: number;
  /** s of the path that stay visible; Infinity: all. */
  trail_time: number;
  /** Body points whose paths are drawn, body frame from the body's origin; empty: centers of mass. */
  trail_points: { body: number; point: Vec3; color: ColorText | null }[];
  /** Frames between two ghosts. */
  ghost_every: number;
  /** Quantities of `--plot`, separated by commas: "energy,body.ball.y". */
  plot: string;
}
