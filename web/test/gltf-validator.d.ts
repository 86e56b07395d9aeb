// The part that the tests use of the package, which has no types.
declare module "gltf-validator" {
  export function validateBytes(data: Uint8Array): Promise<{
    issues: { numErrors: number; messages: { code: string; message: string; severity: number; pointer: string }[] };
    info: { animationCount: number; totalVertexCount: number };
  }>;
}
