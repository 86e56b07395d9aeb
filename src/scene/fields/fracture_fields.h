// Fields of `fracture` of a body, and the keys of materials that it needs.
#pragma once

#include "scene/description/fracture.h"
#include "scene/fields/choices.h"
#include "scene/fields/field.h"
#include "scene/toml/limits.h"

#include <limits>
#include <optional>

namespace tumble {

template <class Visitor, class Self>
void visit_fields(Of<FractureRequest>, Visitor& field, Self& self) {
    field(self.cells, "cells", Whole{2, limits::fracture_cells},
          {"number of cells; of bricks and of a radial pattern about that many"});
    field(self.pattern, "pattern", ByType());
    field(
        self.seed, "seed", Whole{0, std::numeric_limits<std::int64_t>::max()},
        {"of random places, with the seed of the scene; copy number i of a grid, a scatter, poses or an instance adds "
         "i"});
    field(self.focus, "focus", ByCode(),
          {"radial: where the spokes meet; voronoi: cells are smaller near it. In the body's frame; `\"impact\"`: the "
           "place of the first blow that breaks the body",
           "the center of the bounds; voronoi none", "±1e9; `\"impact\"`", "vector, m; or string"});
    field.since(self.focus_at_impact, self.focus_at_impact);
    field(self.axis, "axis", Direction(), {"slabs: their normal", "the longest one of the bounds"});
    field(self.depth, "depth", Whole{0, 1000},
          {"number of times that a piece may break again", "none: down to single cells"});
    field(self.smallest, "smallest", limits::size,
          {"cells of less than its cube are merged into their neighbors", "a thousandth of the cube root of the volume",
           "1e-6 of the longest extent and up"});
    field(self.held, "held", ByCode(),
          {"sides of the bounds at which cells hold to the world; of fixed and kinematic bodies", "`[\"-y\"]`",
           "`\"-x\"`, `\"+x\"`, `\"-y\"`, `\"+y\"`, `\"-z\"`, `\"+z\"`", "array of strings"});
}

/// Properties given by a material, or by a body itself.
struct FractureMaterial {
    std::optional<double> strength;              // Pa
    std::optional<double> shear_strength;        // Pa
    std::optional<double> compressive_strength;  // Pa
    std::optional<double> stiffness;             // Pa
    std::optional<double> toughness;             // J/m^2
    std::optional<double> blow_time;             // s
    std::optional<Color> inner_color;
};

template <class Visitor, class Self>
void visit_fields(Of<FractureMaterial>, Visitor& field, Self& self) {
    field(self.strength, "strength", limits::stress, {"in tension", "required with `fracture`"});
    field(self.shear_strength, "shear_strength", limits::stress, {{}, "1.6 of the strength"});
    field(self.compressive_strength, "compressive_strength", limits::stress_or_zero,
          {"0: pressure breaks nothing", "0"});
    field(self.stiffness, "stiffness", limits::elasticity,
          {"Young's modulus: stiffer places take more of a load", "1,000 times the strength"});
    field(self.toughness, "toughness", limits::toughness, {"energy of a crack by its area", "10"});
    field(self.blow_time, "blow_time", limits::blow_time,
          {"duration of a blow, which makes a force of its impulse. 0: twice the diagonal of the bounds over the speed "
           "of "
           "sound √(stiffness/density)",
           "0"});
    field(self.inner_color, "inner_color", ByType(), {"of new faces", "a paler color than the body's"});
}

}  // namespace tumble
