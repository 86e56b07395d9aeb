// `data-live` of a player's figure: what a reader may change, and the scene that it changes.

/** A slider, or a choice where it has `choices`. Numbers are decimal text: they reach the scene as they are shown. */
export interface LiveControl {
  /** As of `--set`: "body.ball.restitution". */
  key: string;
  label: string;
  unit: string;
  min?: string;
  max?: string;
  step?: string;
  choices?: string[];
  /** Of the recorded run; absent: the scene does not give it. */
  value?: string;
}

export interface LiveOptions {
  /** Of the scene file. */
  name: string;
  /** Index of the scene's text in the sources of the clip. */
  source: number;
  /** PATH=VALUE of the recorded run. */
  settings: string[];
  controls: LiveControl[];
  /** Whether the scene's text can be changed. */
  editor: boolean;
  /** Of a page that was saved with its settings. */
  saved?: { values: Record<string, string>; text?: string };
}

export function read_live_options(figure: HTMLElement): LiveOptions | null {
  const text = figure.dataset.live;
  return text ? (JSON.parse(text) as LiveOptions) : null;
}
