// Pages in a real Chromium, without network: each page records its requests, messages, errors and violations of its policy.
// A test file has one browser for each set of command-line arguments; they close when its tests have ended.
import { after } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium, type Browser, type BrowserContext, type Page } from "playwright-core";
import { chromium_path } from "./paths.mjs";

export interface PageOptions {
  /** Of the viewport, CSS pixels. Small ones are faster: there is no GPU. */
  width?: number;
  height?: number;
  dark?: boolean;
  /** Of the reader: "de-AT". */
  language?: string;
  reduced_motion?: boolean;
  java_script?: boolean;
  /** More arguments of Chromium: no_webgl. */
  args?: string[];
  /** Waited for until it is in the document; the default is a player that has ended loading. "" waits for nothing. */
  wait_for?: string;
}

/** Chromium without WebGL. */
export const no_webgl = ["--disable-3d-apis"];

export interface OpenedPage {
  page: Page;
  /** Addresses other than the page's own and those of data in it. */
  requests: string[];
  /** Texts of the console. */
  messages: string[];
  /** Uncaught exceptions. */
  errors: string[];
  /** Violations of the content security policy. */
  violations(): Promise<string[]>;
  /** All four, to be compared with []. */
  problems(): Promise<string[]>;
  /** `document.documentElement.dataset.player`: "ready", "no-webgl", "failed". */
  player_state(): Promise<string>;
  close(): Promise<void>;
}

const browsers = new Map<string, Promise<Browser>>();
after(async () => {
  for (const browser of browsers.values()) await (await browser).close();
});

/** The browser with these arguments; it is started once. */
export function launch(args: string[] = []): Promise<Browser> {
  const key = args.join(" ");
  let browser = browsers.get(key);
  if (!browser) {
    browser = chromium.launch({
      executablePath: chromium_path(),
      chromiumSandbox: false,   // refuses to start as root
      args: ["--enable-unsafe-swiftshader", "--no-first-run", "--disable-background-networking", "--disable-component-update",
             "--disable-sync", ...args],
    });
    browsers.set(key, browser);
  }
  return browser;
}

/** Opens a file and waits until its player is ready or has failed. */
export async function open_page(path: string, options: PageOptions = {}): Promise<OpenedPage> {
  const browser = await launch(options.args);
  const context = await browser.newContext({
    offline: true,
    viewport: { width: options.width ?? 640, height: options.height ?? 360 },
    locale: options.language ?? "en-US",
    colorScheme: options.dark ? "dark" : "light",
    reducedMotion: options.reduced_motion ? "reduce" : "no-preference",
    javaScriptEnabled: options.java_script ?? true,
  });
  context.setDefaultTimeout(60_000);   // of a loaded machine
  await context.addInitScript(record_violations);
  const page = await context.newPage();
  const opened = await record(page, context, pathToFileURL(path).href);
  await page.goto(pathToFileURL(path).href);
  const wait_for = options.wait_for ?? 'html[data-player]:not([data-player="loading"])';
  if (wait_for) await page.waitForSelector(wait_for, { state: "attached" });
  return opened;
}

// Runs in the page, before its scripts.
function record_violations() {
  const found: string[] = [];
  Object.assign(window, { recorded_violations: found });
  addEventListener("securitypolicyviolation", (event) => {
    found.push(`${event.violatedDirective} refuses ${event.blockedURI || event.sample}`);
  }, true);
}

async function record(page: Page, context: BrowserContext, own_address: string): Promise<OpenedPage> {
  const requests: string[] = [], messages: string[] = [], errors: string[] = [];
  await context.route("**", (route) => (/^(file|data|blob):/.test(route.request().url()) ? route.continue() : route.abort()));
  page.on("request", (request) => {
    const address = request.url();
    if (address.split("#")[0] !== own_address && !/^(data|blob):/.test(address)) requests.push(address);
  });
  page.on("websocket", (socket) => requests.push(socket.url()));
  page.on("pageerror", (error) => errors.push(error.stack ?? error.message));
  page.on("console", (message) => {
    // Of Chromium itself, where pixels are read without a GPU.
    if (!/GPU stall due to ReadPixels/.test(message.text())) messages.push(`${message.type()}: ${message.text()}`);
  });
  const violations = () =>
    page.evaluate(() => [...(window as unknown as { recorded_violations: string[] }).recorded_violations]);
  return {
    page, requests, messages, errors, violations,
    problems: async () => [
      ...requests.map((r) => `request ${r}`), ...messages.map((m) => `message ${m}`), ...errors.map((e) => `error ${e}`),
      ...(await violations()).map((v) => `violation ${v}`)],
    player_state: async () => (await page.getAttribute("html", "data-player")) ?? "",
    close: () => context.close(),
  };
}
