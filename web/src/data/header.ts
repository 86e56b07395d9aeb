// The JSON header of the clip data, as src/page writes it.
import type { ArrayReference, PredictedReference } from "./container.ts";
import type { Body, Cord, Camera, EnergyTable, JointMarks, OverlaySettings, RunSettings, Vec3, Light, Water } from "./clip.ts";

export interface ClipHeader {
  format: number;
  title: string;
  generator: string;
  sources: { name: string; text: string }[];
  runs: RunHeader[];
  meshes: MeshHeader[];
  textures?: TexelsHeader[];
}

/** Quantum, order of the differences, and array. */
export type ColumnReference = [number, number, ArrayReference];

export interface RunHeader {
  label: string;
  fps: number;
  frames: number;
  /** s, the times of the frames of a clip whose speed changes. */
  pace?: number[];
  settings: RunSettings;
  bodies: Body[];
  cords: Cord[];
  light: Light;
  environment?: EnvironmentHeader;
  water?: Water;
  exposure?: number;
  tone?: "filmic" | "linear";
  camera: Camera & { quantum?: number; frames?: PredictedReference[] };
  motion: MotionHeader;
  energy: Record<keyof EnergyTable, ArrayReference>;
  joints: Record<string, ArrayReference>;
  impacts: ImpactsHeader;
  all_impacts: number;
  contacts: ContactsHeader;
  all_contacts: number;
  /** Body, and columns of each component. */
  loads: [number, ColumnReference[]][];
  joint_marks: (Omit<JointMarks, "states" | "force" | "torque"> & {
    states: ArrayReference; force: ColumnReference[]; torque: ColumnReference[];
  })[];
  /** Of three bodies each: see CrackMarks. */
  cracks?: { bodies: ArrayReference; counts: ArrayReference; places: ArrayReference };
  overlays: Omit<OverlaySettings, "trail_time"> & { trail_time: number | null };
}

export interface MeshHeader {
  min: Vec3;
  quantum: number;
  positions: PredictedReference[];
  normals: PredictedReference[];
  indices: PredictedReference;
  paint?: PaintHeader;
}

/** Colors of the mesh's file by vertex, and its textures: groups of consecutive indices. */
export interface PaintHeader {
  uv_steps: number;
  color_steps: number;
  uv: PredictedReference[];
  /** Square roots of linear light, as are the texels. */
  color: PredictedReference[];
  emission: PredictedReference[];
  /** Roughness and metallic; below 0: the body's. */
  surface: PredictedReference[];
  groups: { first: number; count: number; texture: TextureHeader | null }[];
}

/** [environment]: colors are linear. */
export interface EnvironmentHeader {
  background: "sky" | "colors" | "image";
  low: Vec3;
  high: Vec3;
  sun: Vec3;
  /** Turn of the image about the y axis, in turns. */
  shift: number;
  ground_shadow: boolean;
  /** Of an image: see light_around() and light_mirrored() of shaders/environment.glsl. */
  around?: Vec3[];
  mirror?: LightHeader;
  image?: LightHeader;
}

/** Texels are square roots of the light over the most that there is, in so many steps. */
export interface LightHeader extends TexelsHeader {
  most: number;
  steps: number;
}

export interface TexelsHeader {
  width: number;
  height: number;
  channels: PredictedReference[];
}

export interface TextureHeader extends TexelsHeader {
  wrap: ["repeat" | "mirror" | "clamp", "repeat" | "mirror" | "clamp"];
  nearest: boolean;
  cutoff: number;
  normal_map?: TexelsHeader;
  surface_map?: TexelsHeader;
  emission_map?: TexelsHeader;
  /** Only of translucent materials. */
  opacity?: number;
}

/** Values have columns: rotation w, x, y, z, position, velocity, angular velocity. */
export interface MotionHeader {
  still: { bodies: number[]; values: ArrayReference };
  keys: { bodies: number[]; counts: ArrayReference; frames: ArrayReference; values: ArrayReference };
  frames: { bodies: number[]; quanta: [number, number, number, number]; orders: ArrayReference; values: ArrayReference };
  /** Columns: rotation, position, velocity and angular velocity before, the same after. */
  events: { counts: ArrayReference; times: ArrayReference; exact: ArrayReference; values: ArrayReference } | null;
  /** Without events: when the bodies are struck, if that is known of all impacts. */
  struck: { counts: ArrayReference; times: ArrayReference } | null;
  asleep: [number, number[]][];
  /** Frames where bodies vanish and appear in turn: pieces, and bodies that break. */
  absent?: [number, number[]][];
  error: { position: number; rotation: number; velocity: number; angular_velocity: number };
}

export interface ImpactsHeader {
  count: number;
  time: ArrayReference;
  exact: ArrayReference;
  frame: ArrayReference;
  a: ArrayReference;
  b: ArrayReference;
  feature: ArrayReference;
  pass: ArrayReference;
  p: ArrayReference[];
  n: ArrayReference[];
  f: ArrayReference[];
  v_before: ArrayReference;
  v_after: ArrayReference;
  restitution: ArrayReference;
  impulse: ArrayReference;
  /** Indices into the bodies' events; -1: none. */
  event_a?: ArrayReference;
  event_b?: ArrayReference;
  /** Row, x, y, z: moments that do not follow from the rest. */
  moments?: [number, number, number, number][];
}

export interface ContactsHeader {
  /** m, of a unit vector, N. */
  quanta: [number, number, number];
  /** Forces are squares of the numbers, with their signs. */
  squares: boolean;
  counts: ArrayReference;
  a: ArrayReference;
  b: ArrayReference;
  /** Point, normal, normal force, tangential force, state, feature. */
  numbers: ArrayReference[];
}
