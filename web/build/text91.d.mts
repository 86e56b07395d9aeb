export const characters: string;
export function encode91(bytes: Uint8Array): string;
