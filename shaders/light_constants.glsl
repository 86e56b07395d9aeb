// All constants of light and color that were chosen by eye. Light is linear and relative: 1 on a white surface is paper
// white on the screen.

// Sun and sky give a face turned to the sun about 1, so that its color on the screen is that of the scene file.
const vec3 sun_light = vec3(0.80, 0.745, 0.655);          // received by a surface facing the sun: a warm late morning
const vec3 sky_light = vec3(0.325, 0.365, 0.435);         // from straight above, without the sun
const vec3 bounce_light = vec3(0.195, 0.185, 0.170);      // from below: a dim reflection of the sunlit ground
const float floor_in_sun = 0.6;                           // part of a floor below a body that the body does not shadow

const vec3 sky_horizon = vec3(0.80, 0.86, 0.92);          // radiance: background, and mirrored by glossy surfaces
const vec3 sky_zenith = vec3(0.20, 0.38, 0.66);
const vec3 sky_nadir = vec3(0.33, 0.39, 0.48);
const float horizon_falloff = 5.0;                               // rate at which the haze at the horizon thins with height (1 / sine)
const vec3 sun_glow = vec3(0.30, 0.24, 0.14);             // added to the sky around the sun

const float dielectric_reflectance = 0.04;                // at normal incidence, of plastic, wood, stone
// share of the mirrored sky left on chalk, so that its colors stay saturated
const float veil_of_rough = 0.2;

const float corner_darkness = 0.5;                        // sky light lost where two planes meet
const float occlusion_of_sun = 0.25;                      // share of that loss that applies to sunlight

const float brightest_highlight = 16.0;                   // of the sun, before its light and the surface's color
const float water_reflectance = 0.02;                     // at normal incidence
const float water_clear_way = 3.0;                        // m of water after which white has the color of the water
const float reflection_way = 0.25;                        // share of the deflection by a wave that a near body has
const float water_glint = 0.03;                           // slope of ripples that no wave has, which widen the sun's image
const float brightest_glint = 300.0;                      // as brightest_highlight, of which water mirrors little
const float bevel_blur = 0.25;                            // of the spread that linear light has on bevels: light is averaged
                                                          // as encoded values, in which highlights weigh less
const float flat_box = 4.0;                               // pixels: thinner boxes have no rounded edges,
const float round_box = 12.0;                             // thicker boxes have full ones

const float ground_contrast = 0.13;                       // between fields of a checker, and of a body's pattern
const float pattern_blur = 1.4;                           // pixels that a pattern is averaged over: smoother than one
const float grid_line_width = 0.022;                      // of a cell
const float grid_line_contrast = 0.30;

const float crate_frame = 0.13;                           // width of a box's frame, in parts of its shortest edge
const float crate_groove = 0.012;                         // width of the groove inside it, in the same unit
const float crate_groove_depth = 0.30;                    // darkness of the groove
const float ball_contrast = 0.16;                         // between a ball's octants, which show its rotation
