// The materials of a stage, and the values that all of them share. The values are set before each view is drawn.
import * as THREE from "three";
import type { Environment, Light, LightTexels, MeshPaint, MeshTexture, Scene, Texels, Vec3 } from "../data/clip.ts";
import type { Look } from "./body_parts.ts";
import { bytes, from_text, to_linear } from "./color.ts";
import {
  body_fragment_glsl, body_vertex_glsl, depth_fragment_glsl, depth_vertex_glsl, outline_fragment_glsl, outline_vertex_glsl,
} from "./body_glsl.ts";
import { plane_fragment_glsl, plane_vertex_glsl, sky_fragment_glsl, sky_vertex_glsl } from "./ground_glsl.ts";
import { occlusion_fragment_glsl, occlusion_vertex_glsl } from "./occlusion_glsl.ts";
import { theme_of, type Theme } from "./theme.ts";
import { water_fragment_glsl, water_vertex_glsl } from "./water_glsl.ts";

export type BodyKind = "box" | "ball" | "mesh";
/** As limits::lamps of src/scene/toml/limits.h. */
const most_lights = 4;
const light_defines = {
  LAMP_LIGHT: "", LAMP_VALUE: "uniform", LAMPS: String(most_lights), SPOTS: "", LAMP_KINDS: "u_lamp_kinds",
};
/** sun_light of shaders/light_constants.glsl. */
const daylight: Vec3 = [0.8, 0.745, 0.655];
const wrapping = { repeat: THREE.RepeatWrapping, mirror: THREE.MirroredRepeatWrapping, clamp: THREE.ClampToEdgeWrapping };

const white: Texels = { width: 1, height: 1, texels: new Uint8Array([255, 255, 255, 255]) };

/** Uniforms and definitions of the images of a material. */
function add_images(material: THREE.ShaderMaterial, texture: MeshTexture | null): void {
  const { wrap, nearest } = texture ?? { wrap: ["clamp", "clamp"] as MeshTexture["wrap"], nearest: false };
  material.uniforms.u_image = { value: filled(texture ?? white, wrap, nearest) };
  material.uniforms.u_cutoff = { value: texture?.cutoff ?? 0 };
  for (const name of ["normal_map", "surface_map", "emission_map"] as const) {
    const map = texture?.[name];
    if (!map) continue;
    material.defines[name.toUpperCase()] = "";
    material.uniforms[name] = { value: filled(map, wrap, nearest) };
  }
  if (texture?.opacity !== undefined) make_translucent(material, texture.opacity);
}

function make_translucent(material: THREE.ShaderMaterial, opacity: number): void {
  material.defines.TRANSLUCENT = "";
  material.uniforms.u_opacity = { value: opacity * (material.uniforms.u_opacity?.value ?? 1) };
  Object.assign(material, { ...translucent, depthWrite: true });
}

/** Images of a look as texture_wraps() of src/scene/description/looks.cpp continues them beyond their edges. */
export function uniforms_of_look(look: Look | undefined, kind: BodyKind | "plane", textures: Texels[]): Uniforms {
  const uniforms: Uniforms = {};
  const { images } = look ?? {};
  if (look?.emission) uniforms.u_glow = { value: new THREE.Vector3(...look.emission) };
  if (look?.opacity !== undefined) uniforms.u_opacity = { value: look.opacity };
  if (!images) return uniforms;
  const around = kind === "plane" || images.scale > 0;
  const wrap: MeshTexture["wrap"] = [around || kind === "ball" ? "repeat" : "clamp", around ? "repeat" : "clamp"];
  const texture = (texels: Texels) => ({ value: filled(texels, wrap, images.nearest) });
  uniforms.u_image = texture(images.image === null ? white : textures[images.image]);
  uniforms.u_image_scale = { value: images.scale };
  if (images.normal_map !== undefined) uniforms.normal_map = texture(textures[images.normal_map]);
  if (images.roughness_map !== undefined) uniforms.surface_map = texture(textures[images.roughness_map]);
  return uniforms;
}

function filled(texels: Texels, wrap: MeshTexture["wrap"], nearest: boolean): THREE.DataTexture {
  const image = new THREE.DataTexture(texels.texels, texels.width, texels.height);
  [image.wrapS, image.wrapT] = wrap.map((name) => wrapping[name]);
  image.magFilter = nearest ? THREE.NearestFilter : THREE.LinearFilter;
  image.minFilter = nearest ? THREE.NearestMipmapLinearFilter : THREE.LinearMipmapLinearFilter;
  image.generateMipmaps = true;
  image.needsUpdate = true;
  return image;
}

/** Light in half floats, which are wide enough for lamps and interpolated everywhere. */
function light_texture({ width, height, light }: LightTexels): THREE.DataTexture {
  const image = new THREE.DataTexture(Uint16Array.from(light, THREE.DataUtils.toHalfFloat), width, height, THREE.RGBAFormat, THREE.HalfFloatType);
  image.wrapS = THREE.RepeatWrapping;
  image.magFilter = image.minFilter = THREE.LinearFilter;
  image.needsUpdate = true;
  return image;
}

type Uniforms = Record<string, THREE.IUniform>;

/** As scene_defines() of src/render/environment: all programs of a stage have them. */
function defines_of_scene({ environment, exposure, tone, water }: Scene): Record<string, string> {
  return {
    ...(environment?.around && { ENVIRONMENT: "" }),
    ...(environment && environment.background !== "sky" && { BACKGROUND: environment.background === "colors" ? "1" : "2" }),
    ...(exposure !== 0 && { EXPOSURE: (2 ** exposure).toExponential() }),
    ...(tone === "linear" && { LINEAR_TONE: "" }),
    ...(water && { WATER: "" }),
    ...(water && water.waves.length > 0 && { WAVES: String(water.waves.length) }),
  };
}

function uniforms_of(environment: Environment | null): Uniforms {
  if (!environment) return {};
  const { low, high, sun, shift, around, mirror, image } = environment;
  return {
    u_low: { value: new THREE.Vector4(...low, shift) },
    u_high: { value: new THREE.Vector4(...high, 0) },
    u_sun_share: { value: new THREE.Vector3(...sun) },
    ...(around && { u_around: { value: around.map((factor) => new THREE.Vector3(...factor)) } }),
    ...(mirror && { environment_map: { value: light_texture(mirror) } }),
    ...(image && { background_image: { value: light_texture(image) } }),
  };
}

export class Materials {
  readonly frame = {
    u_to_light: { value: new THREE.Vector3(0, 1, 0) },
    u_sky: { value: new THREE.Vector3(1, 1, 1) },
    u_dim: { value: 1 },
    u_fog: { value: 0 },
    u_pixel_size: { value: 0 },
    u_shadow_matrix: { value: new THREE.Matrix4() },
    u_shadow_map: { value: null as THREE.Texture | null },
    u_shadow_size: { value: 1 },
    u_shadow_texel: { value: 0 },
    u_outline: { value: new THREE.Vector2() },
    u_outline_color: { value: new THREE.Vector3(...bytes(255, 176, 0)) },
    u_ray_center: { value: new THREE.Vector3() },
    u_ray_right: { value: new THREE.Vector3() },
    u_ray_up: { value: new THREE.Vector3() },
    v_sun: { value: new THREE.Vector3() },
    v_lamp_place: { value: Array.from({ length: most_lights }, () => new THREE.Vector3()) },
    v_lamp_light: { value: Array.from({ length: most_lights }, () => new THREE.Vector3()) },
    v_lamp_axis: { value: Array.from({ length: most_lights }, () => new THREE.Vector4()) },
    u_lamp_kinds: { value: 0 },
  };
  readonly solid: Record<BodyKind, THREE.ShaderMaterial>;
  readonly ghost: Record<BodyKind, THREE.ShaderMaterial>;
  readonly outline: Record<BodyKind, THREE.ShaderMaterial>;
  readonly depth: THREE.ShaderMaterial;
  readonly sky: THREE.ShaderMaterial;
  /** See u_waves of shading_glsl.ts. */
  readonly waves: THREE.Vector4[];

  private readonly of_scene: Uniforms;
  private readonly defines: Record<string, string>;
  private readonly painted_of = new Map<MeshPaint, Map<string, THREE.ShaderMaterial[]>>();
  private readonly looks = new Map<string, THREE.ShaderMaterial>();

  /** `scene`: its environment and tone are those of the stage. `several_lights`: in one of the scenes. */
  constructor(scene: Scene, private readonly several_lights = false) {
    const { environment, water } = scene;
    this.waves = (water?.waves ?? []).map(() => new THREE.Vector4());
    this.of_scene = {
      ...uniforms_of(environment),
      ...(water && { u_water: { value: new THREE.Vector4(...to_linear(from_text(water.color)), water.level) } }),
      ...(this.waves.length > 0 && { u_waves: { value: this.waves } }),
    };
    this.defines = defines_of_scene(scene);
    this.solid = this.for_kinds((kind) => this.body(kind, false));
    this.ghost = this.for_kinds((kind) => this.body(kind, true));
    this.outline = this.for_kinds((kind) =>
      this.make(outline_vertex_glsl, outline_fragment_glsl, { defines: defines_of(kind), side: THREE.BackSide }),
    );
    this.depth = this.make(depth_vertex_glsl, depth_fragment_glsl, { side: THREE.DoubleSide });
    this.sky = this.make(sky_vertex_glsl, sky_fragment_glsl, { depthWrite: false });
  }

  /** Of a scene; without several lights in another one, it has the sun of light_constants.glsl. */
  set_lights({ color = daylight, others = [] }: Light): void {
    const { v_sun, v_lamp_place, v_lamp_light, v_lamp_axis, u_lamp_kinds } = this.frame;
    v_sun.value.set(...color);
    for (const light of v_lamp_light.value) light.set(0, 0, 0);
    u_lamp_kinds.value = 0;
    others.forEach(({ kind, place, light, axis, cosine }, i) => {
      v_lamp_place.value[i].set(...place);
      v_lamp_light.value[i].set(...light);
      v_lamp_axis.value[i].set(...axis, cosine);
      u_lamp_kinds.value |= kind << (2 * i);
    });
  }

  plane(uniforms: Uniforms, look: Look | undefined): THREE.ShaderMaterial {
    const material = this.make(plane_vertex_glsl, plane_fragment_glsl, { defines: defines_of_look(look) });
    Object.assign(material.uniforms, uniforms);
    return material;
  }

  /** One material for each group of the mesh, which has its texture. */
  painted(paint: MeshPaint, look: Look | undefined): THREE.ShaderMaterial[] {
    const key = look ? JSON.stringify(look) : "";
    const of_paint = this.painted_of.get(paint) ?? new Map<string, THREE.ShaderMaterial[]>();
    this.painted_of.set(paint, of_paint);
    let materials = of_paint.get(key);
    if (!materials) {
      materials = paint.groups.map(({ texture }) => {
        const defines = { PAINTED: "", ...(texture && texture.cutoff > 0 ? { HOLES: "" } : {}), ...defines_of_look(look) };
        const material = this.make(body_vertex_glsl, body_fragment_glsl, { defines, side: THREE.DoubleSide });
        add_images(material, texture);
        if (look?.emission) material.uniforms.u_glow = { value: new THREE.Vector3(...look.emission) };
        if (look?.opacity !== undefined) make_translucent(material, look.opacity);
        return material;
      });
      of_paint.set(key, materials);
    }
    return materials;
  }

  of_look(kind: BodyKind, look: Look, textures: Texels[]): THREE.ShaderMaterial {
    const key = `${kind} ${JSON.stringify(look)}`;
    let material = this.looks.get(key);
    if (!material) {
      material = this.make(body_vertex_glsl, body_fragment_glsl,
        { defines: { ...defines_of(kind), ...defines_of_look(look) }, side: sides_of(kind) });
      Object.assign(material.uniforms, uniforms_of_look(look, kind, textures));
      if (look.opacity !== undefined) Object.assign(material, { ...translucent, depthWrite: true });
      this.looks.set(key, material);
    }
    return material;
  }

  /** Precondition: the scene has water. */
  water_surface(): THREE.ShaderMaterial {
    const material = this.make(water_vertex_glsl, water_fragment_glsl, { side: THREE.DoubleSide, ...translucent });
    material.uniforms.u_foot = { value: new THREE.Vector2() };
    return material;
  }

  /** Multiplies the ground that it lies on. */
  occlusion(): THREE.ShaderMaterial {
    const material = this.make(occlusion_vertex_glsl, occlusion_fragment_glsl, {
      depthWrite: false, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -4, blending: THREE.CustomBlending,
      blendEquation: THREE.AddEquation, blendSrc: THREE.DstColorFactor, blendDst: THREE.ZeroFactor,
    });
    material.uniforms.u_normal = { value: new THREE.Vector3(0, 1, 0) };
    return material;
  }

  set_theme(theme: Theme): void {
    const { sky, ground } = theme_of(theme);
    this.frame.u_sky.value.set(...sky);
    this.frame.u_dim.value = ground;
  }

  dispose(): void {
    for (const list of [this.solid, this.ghost, this.outline]) for (const material of Object.values(list)) material.dispose();
    for (const materials of [...this.painted_of.values()].flatMap((of_paint) => [...of_paint.values()]))
      for (const material of materials) dispose_with_images(material);
    for (const material of this.looks.values()) dispose_with_images(material);
    this.depth.dispose();
    this.sky.dispose();
    this.of_scene.environment_map?.value.dispose();
    this.of_scene.background_image?.value.dispose();
  }

  private body(kind: BodyKind, ghost: boolean): THREE.ShaderMaterial {
    const defines = { ...defines_of(kind), ...(ghost ? { GHOST: "" } : {}) };
    if (!ghost) return this.make(body_vertex_glsl, body_fragment_glsl, { defines, side: sides_of(kind) });
    // Without writing depths: the front of a ghost is one layer, whatever is drawn first.
    return this.make(body_vertex_glsl, body_fragment_glsl, { defines, ...translucent });
  }

  private make(vertexShader: string, fragmentShader: string, more: THREE.ShaderMaterialParameters): THREE.ShaderMaterial {
    const defines = { ...more.defines, ...(this.several_lights ? light_defines : {}) };
    return new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, uniforms: { ...this.frame, ...this.of_scene }, vertexShader, fragmentShader, ...more,
      defines: { ...this.defines, ...defines },
    });
  }

  private for_kinds<T>(make: (kind: BodyKind) => T): Record<BodyKind, T> {
    return { box: make("box"), ball: make("ball"), mesh: make("mesh") };
  }
}

function dispose_with_images(material: THREE.ShaderMaterial): void {
  for (const name of ["u_image", "normal_map", "surface_map", "emission_map"]) material.uniforms[name]?.value.dispose();
  material.dispose();
}

/** Colors multiplied by their opacity are blended over the picture. */
export const translucent = {
  transparent: true,
  depthWrite: false,
  blending: THREE.CustomBlending,
  blendEquation: THREE.AddEquation,
  blendSrc: THREE.OneFactor,
  blendDst: THREE.OneMinusSrcAlphaFactor,
} as const;

function defines_of_look(look: Look | undefined): Record<string, string> {
  const defines: Record<string, string> = {};
  if (look?.colors !== undefined) defines.TWO_COLORS = String(look.colors);
  if (look?.images) defines.IMAGE = "";
  if (look?.images?.normal_map !== undefined) defines.NORMAL_MAP = "";
  if (look?.images?.roughness_map !== undefined) defines.SURFACE_MAP = "";
  if (look?.emission) defines.GLOWING = "";
  if (look?.opacity !== undefined) defines.TRANSLUCENT = "";
  return defines;
}
const defines_of = (kind: BodyKind): Record<string, string> => ({ [kind.toUpperCase()]: "" });
// The inside of an open mesh is visible.
const sides_of = (kind: BodyKind) => (kind === "mesh" ? THREE.DoubleSide : THREE.FrontSide);
