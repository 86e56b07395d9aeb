// Icons of the controls: paths in a square of 24.
import { svg } from "./dom.ts";

const paths = {
  play: "M8 5.5v13l10.5-6.5z",
  pause: "M7.5 5.5h3.4v13H7.5zM13.1 5.5h3.4v13h-3.4z",
  next_frame: "M7 6.5v11l8-5.5zM15.6 6.5h1.9v11h-1.9z",
  previous_frame: "M17 6.5v11l-8-5.5zM6.5 6.5h1.9v11H6.5z",
  next_impact: "M5 6.5v11l6.5-5.5zM11.5 6.5v11l6.5-5.5zM18 6.5h1.7v11H18z",
  previous_impact: "M19 6.5v11l-6.5-5.5zM12.5 6.5v11L6 12zM4.3 6.5H6v11H4.3z",
  loop: "M7 7h9.2l-2-2 1.3-1.2L19.7 8l-4.2 4.2-1.3-1.3 2-2H8.8v3.4H7zm10 10H7.8l2 2-1.3 1.2L4.3 16l4.2-4.2 1.3 1.3-2 2h7.4v-3.4H17z",
  reset: "M12 5a7 7 0 1 1-6.6 4.7l1.7.6A5.2 5.2 0 1 0 12 6.8v2.7L7.8 6 12 2.5z",
  follow: "M12 8.2a3.8 3.8 0 1 1 0 7.6 3.8 3.8 0 0 1 0-7.6zM11.1 3h1.8v3.4h-1.8zm0 14.600h1.8V21h-1.8zM3 11.100h3.400v1.8H3zm14.6 0H21v1.8h-3.400z",
  full_screen: "M5 5h5v1.800H6.800V10H5zm9 0h5v5h-1.800V6.800H14zM5 14h1.800v3.200H10V19H5zm12.2 0H19v5h-5v-1.800h3.200z",
  help: "M12 4a8 8 0 1 1 0 16 8 8 0 0 1 0-16zm0 1.700a6.3 6.3 0 1 0 0 12.6 6.3 6.3 0 0 0 0-12.600zm-.9 9.100h1.800v1.800h-1.800zm.9-7c1.8 0 3.1 1.1 3.1 2.7 0 1.2-.7 1.8-1.3 2.3-.6.4-.9.7-.9 1.200h-1.800c0-1.4.8-2 1.5-2.5.5-.4.7-.6.7-1 0-.6-.5-1.1-1.3-1.100s-1.4.5-1.5 1.300l-1.7-.300C9 9 10.2 7.8 12 7.800z",
  theme: "M12 4a8 8 0 1 1 0 16 8 8 0 0 1 0-16zm0 1.700v12.600a6.3 6.3 0 0 0 0-12.600z",
  close: "M6.7 5.5 12 10.800l5.3-5.3 1.2 1.2-5.3 5.3 5.3 5.3-1.2 1.2-5.3-5.3-5.3 5.3-1.2-1.2 5.3-5.3-5.3-5.300z",
  copy: "M8 4h10v12h-2.500v4H5V8h3zm1.7 1.700V8h5.800v6.300h.8V5.700zM6.7 9.700v8.600h7.100V9.700z",
};
export type IconName = keyof typeof paths;

export function icon(name: IconName): SVGElement {
  return svg("svg", { viewBox: "0 0 24 24", width: 20, height: 20, "aria-hidden": "true", focusable: "false" },
    svg("path", { d: paths[name] }));
}

export function set_icon(button: HTMLElement, name: IconName): void {
  button.querySelector("path")!.setAttribute("d", paths[name]);
}
