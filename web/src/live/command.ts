// The command that gives the run of a live page again.

/** A word for a shell of POSIX. */
export function shell_word(text: string): string {
  return /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

/** `settings`: PATH=VALUE. */
export function simulate_command(name: string, settings: string[]): string {
  return ["tumble simulate", shell_word(name), ...settings.map((each) => `--set ${shell_word(each)}`)].join(" ");
}
