// The list of the keys.
import { h, new_id } from "./dom.ts";
import { key_bindings } from "./keyboard.ts";
import { icon_button } from "./transport.ts";
import { text_of } from "../texts/texts.ts";

export function build_help(): { element: HTMLDialogElement; show: () => void } {
  const title = new_id("tp-help");
  const element = h("dialog", { class: "tp-help", "aria-labelledby": title });
  element.append(
    h("header", {}, h("h2", { id: title }, text_of("keys")), icon_button("close", text_of("close"), text_of("key_escape"), () => element.close())),
    h("p", {}, text_of("help")),
    h("dl", {}, ...key_bindings.map((binding) => h("div", {}, h("dt", {}, binding.shown), h("dd", {}, binding.does)))));
  // A click beside the dialog is a click on its backdrop.
  element.addEventListener("click", (event) => { if (event.target === element) element.close(); });
  return { element, show: () => element.showModal() };
}
