// The settings of a live run: as the command that gives it again, and as words.

/** A word for a shell of POSIX. */
export function shell_word(text: string): string {
  return /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

/** `settings`: PATH=VALUE. */
export function simulate_command(name: string, settings: string[]): string {
  return ["tumble simulate", shell_word(name), ...settings.map((each) => `--set ${shell_word(each)}`)].join(" ");
}

/** "body.ball.angular_velocity.2=0.5" as "angular velocity z 0.5". */
export function setting_words(setting: string): string {
  const [key, value] = [setting.slice(0, setting.indexOf("=")), setting.slice(setting.indexOf("=") + 1)];
  const path = key.split(".");
  const axis = path.length > 1 && /^[0-2]$/.test(path.at(-1)!) ? "xyz"[Number(path.pop())] : "";
  return [path.at(-1)!.replaceAll("_", " "), axis, value].filter(Boolean).join(" ");
}
