// Colors and dashes of plots. Okabe and Ito's palette: told apart with all common forms of color blindness.
export const run_colors_light = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#a6780f", "#3d8fc4", "#333333"];
export const run_colors_dark = ["#56b4e9", "#e69f00", "#2fbf95", "#e08fbf", "#f0e442", "#7aa7ff", "#dddddd"];
/** Colors repeat after seven runs, dashes do not yet. */
export const run_dashes: number[][] = [[], [7, 4], [2, 3], [9, 3, 2, 3], [5, 2], [1, 2], [10, 5]];

/** By the keys of the energy table. */
export const energy_colors_light: Record<string, string> = {
  potential: "#7fb3d9", elastic: "#b5d6a7", kinetic_linear: "#f0b25a", kinetic_angular: "#e07b42",
  impact_loss: "#c9c4bd", friction_loss: "#a8a29a",
};
export const energy_colors_dark: Record<string, string> = {
  potential: "#2f6d99", elastic: "#4d8a62", kinetic_linear: "#c98a2b", kinetic_angular: "#b85a26",
  impact_loss: "#55524e", friction_loss: "#6f6b66",
};
