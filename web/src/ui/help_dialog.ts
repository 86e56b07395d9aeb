// The list of the keys.
import { h, new_id } from "./dom.ts";
import { key_bindings } from "./keyboard.ts";
import { icon_button } from "./transport.ts";

export function build_help(): { element: HTMLDialogElement; show: () => void } {
  const title = new_id("tp-help");
  const element = h("dialog", { class: "tp-help", "aria-labelledby": title });
  element.append(
    h("header", {}, h("h2", { id: title }, "Keys"), icon_button("close", "Close", "escape", () => element.close())),
    h("p", {}, "They work where the player has the focus: click on it, or reach it with the tab key."),
    h("dl", {}, ...key_bindings.map((binding) => h("div", {}, h("dt", {}, binding.shown), h("dd", {}, binding.does)))));
  // A click beside the dialog is a click on its backdrop.
  element.addEventListener("click", (event) => { if (event.target === element) element.close(); });
  return { element, show: () => element.showModal() };
}
