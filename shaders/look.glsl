// The look: every constant of light and color that was chosen by eye, in one place.
// Light is linear and relative: 1 on a white surface is paper white on the screen.

// Sun and sky give a face turned to the sun about 1, so that its color on the screen is the scene file's.
const vec3 sun_light = vec3(0.80, 0.745, 0.655);          // what a surface facing the sun receives: a warm late morning
const vec3 sky_light = vec3(0.325, 0.365, 0.435);         // from straight above, without the sun
const vec3 bounce_light = vec3(0.195, 0.185, 0.170);      // from below: the sunlit ground, seen dimly

const vec3 sky_horizon = vec3(0.80, 0.86, 0.92);          // radiance: the backdrop and what shiny things mirror
const vec3 sky_zenith = vec3(0.20, 0.38, 0.66);
const vec3 sky_nadir = vec3(0.33, 0.39, 0.48);
const float sky_haze = 5.0;                               // how fast the horizon's haze thins with height (1 / sine)
const vec3 sun_glow = vec3(0.30, 0.24, 0.14);             // added to the sky around the sun

const float dielectric_reflectance = 0.04;                // at normal incidence, of plastic, wood, stone
const float veil_of_rough = 0.2;                          // what is left of the mirrored sky on chalk: colors stay rich

const float corner_darkness = 0.5;                        // sky light lost where two planes meet
const float occlusion_of_sun = 0.25;                      // share of that loss which sunlight feels

const float brightest_highlight = 16.0;                   // of the sun, before its light and the surface's color
const float bevel_blur = 0.25;                            // of the spread that linear light has on bevels: light is averaged
                                                          // as it is shown, where highlights weigh less
const float flat_box = 4.0;                               // pixels: thinner boxes have no rounded edges,
const float round_box = 12.0;                             // thicker ones whole ones

const float ground_contrast = 0.13;                       // of a checker's fields and a body's pattern
const float pattern_blur = 1.4;                           // pixels that a pattern is averaged over: calmer than one
const float grid_line_width = 0.022;                      // of a cell
const float grid_line_contrast = 0.30;

const float crate_frame = 0.13;                           // width of a box's frame, in parts of its shortest edge
const float crate_groove = 0.012;                         // width of the groove inside it, likewise
const float crate_groove_depth = 0.30;                    // how dark the groove is
const float ball_contrast = 0.16;                         // between a ball's octants, which show how it turns
