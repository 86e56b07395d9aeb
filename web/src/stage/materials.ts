// The materials of a stage, and the values that all of them share. The values are set before each view is drawn.
import * as THREE from "three";
import type { MeshPaint, MeshTexture, Texels } from "../data/clip.ts";
import type { Look } from "./body_parts.ts";
import { bytes } from "./color.ts";
import {
  body_fragment_glsl, body_vertex_glsl, depth_fragment_glsl, depth_vertex_glsl, outline_fragment_glsl, outline_vertex_glsl,
} from "./body_glsl.ts";
import { plane_fragment_glsl, plane_vertex_glsl, sky_fragment_glsl, sky_vertex_glsl } from "./ground_glsl.ts";
import { occlusion_fragment_glsl, occlusion_vertex_glsl } from "./occlusion_glsl.ts";
import { theme_of, type Theme } from "./theme.ts";

export type BodyKind = "box" | "ball" | "mesh";
const wrapping = { repeat: THREE.RepeatWrapping, mirror: THREE.MirroredRepeatWrapping, clamp: THREE.ClampToEdgeWrapping };

/** A white texel without a texture. */
function image_of(texture: MeshTexture | null): THREE.DataTexture {
  if (texture) return filled(texture, texture.wrap, texture.nearest);
  const white = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1);
  white.needsUpdate = true;
  return white;
}

/** The image of a look as texture_wraps() of src/scene/description/looks.cpp continues it beyond its edges. */
export function image_of_look(image: Texels, kind: BodyKind | "plane", scale: number, nearest: boolean): THREE.DataTexture {
  const around = kind === "plane" || scale > 0;
  return filled(image, [around || kind === "ball" ? "repeat" : "clamp", around ? "repeat" : "clamp"], nearest);
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

type Uniforms = Record<string, THREE.IUniform>;

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
  };
  readonly solid = this.for_kinds((kind) => this.body(kind, false));
  readonly ghost = this.for_kinds((kind) => this.body(kind, true));
  readonly outline = this.for_kinds((kind) =>
    this.make(outline_vertex_glsl, outline_fragment_glsl, { defines: defines_of(kind), side: THREE.BackSide }),
  );
  readonly depth = this.make(depth_vertex_glsl, depth_fragment_glsl, { side: THREE.DoubleSide });
  readonly sky = this.make(sky_vertex_glsl, sky_fragment_glsl, { depthWrite: false });

  private readonly painted_of = new Map<MeshPaint, Map<string, THREE.ShaderMaterial[]>>();
  private readonly looks = new Map<string, THREE.ShaderMaterial>();

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
        material.uniforms.u_image = { value: image_of(texture) };
        material.uniforms.u_cutoff = { value: texture?.cutoff ?? 0 };
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
      if ("image" in look) {
        material.uniforms.u_image = { value: image_of_look(textures[look.image], kind, look.scale, look.nearest) };
        material.uniforms.u_image_scale = { value: look.scale };
      }
      this.looks.set(key, material);
    }
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
      for (const material of materials) {
        material.uniforms.u_image.value.dispose();
        material.dispose();
      }
    for (const material of this.looks.values()) {
      material.uniforms.u_image?.value.dispose();
      material.dispose();
    }
    this.depth.dispose();
    this.sky.dispose();
  }

  private body(kind: BodyKind, ghost: boolean): THREE.ShaderMaterial {
    const defines = { ...defines_of(kind), ...(ghost ? { GHOST: "" } : {}) };
    if (!ghost) return this.make(body_vertex_glsl, body_fragment_glsl, { defines, side: sides_of(kind) });
    // Without writing depths: the front of a ghost is one layer, whatever is drawn first.
    return this.make(body_vertex_glsl, body_fragment_glsl, { defines, ...translucent });
  }

  private make(vertexShader: string, fragmentShader: string, more: THREE.ShaderMaterialParameters): THREE.ShaderMaterial {
    return new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, uniforms: { ...this.frame }, vertexShader, fragmentShader, ...more,
    });
  }

  private for_kinds<T>(make: (kind: BodyKind) => T): Record<BodyKind, T> {
    return { box: make("box"), ball: make("ball"), mesh: make("mesh") };
  }
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

const defines_of_look = (look: Look | undefined): Record<string, string> =>
  !look ? {} : "image" in look ? { IMAGE: "" } : { TWO_COLORS: String(look.colors) };
const defines_of = (kind: BodyKind): Record<string, string> => ({ [kind.toUpperCase()]: "" });
// The inside of an open mesh is visible.
const sides_of = (kind: BodyKind) => (kind === "mesh" ? THREE.DoubleSide : THREE.FrontSide);
