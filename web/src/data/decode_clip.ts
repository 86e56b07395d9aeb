// The clip of a page from its data: base64 of raw deflate of the container that src/page writes.
import type { Clip, Mesh, Run, Texels } from "./clip.ts";
import { Container } from "./container.ts";
import type { ClipHeader, RunHeader } from "./header.ts";
import { inflate } from "./inflate.ts";
import { DecodedMotion, read_events } from "./motion.ts";
import { read_mesh, read_scene, read_texels } from "./scene.ts";
import { read_contacts, read_cracks, read_energy, read_impacts, read_joint_marks, read_joints, read_loads, read_struck_times } from "./tables.ts";

const known_format = 1;

function read_run(run: RunHeader, reader: Container<ClipHeader>, meshes: Mesh[], textures: Texels[]): Run {
  const events = read_events(run.motion, run.settings.step, reader);
  const motion = new DecodedMotion(run, reader, events, read_struck_times(run, reader));
  return {
    label: run.label,
    duration: (run.frames - 1) / run.fps,
    fps: run.fps,
    pace: run.pace ?? [],
    frames: run.frames,
    settings: run.settings,
    scene: read_scene(run, reader, meshes, textures),
    motion,
    energy: read_energy(run, reader),
    joints: read_joints(run, reader),
    impacts: read_impacts(run, reader, events, motion),
    all_impacts: run.all_impacts,
    contacts: read_contacts(run, reader),
    all_contacts: run.all_contacts,
    loads: read_loads(run, reader, motion),
    joint_marks: read_joint_marks(run, reader),
    cracks: read_cracks(run, reader),
    overlays: { ...run.overlays, trail_time: run.overlays.trail_time ?? Infinity },
  };
}

/** Throws an Error whose message a reader understands, if the data is damaged. */
export async function decode_clip(base64: string): Promise<Clip> {
  return read_clip(await inflate(base64));
}

/** The same, of the container itself. */
export function read_clip(bytes: Uint8Array): Clip {
  const reader = new Container<ClipHeader>(bytes);
  const { format, title, generator, sources, runs } = reader.header;
  if (format !== known_format)
    throw new Error(`The clip's data has the format ${format}, and this player reads ${known_format} only.`);
  const meshes = reader.header.meshes.map((mesh) => read_mesh(mesh, reader));
  const textures = (reader.header.textures ?? []).map((image) => read_texels(image, reader));
  return { title, generator, sources, runs: runs.map((run) => read_run(run, reader, meshes, textures)) };
}
