#include "render/antialiasing/antialiasing.h"

#include "render/antialiasing/analytic_aa.h"
#include "render/antialiasing/coverage.h"
#include "render/antialiasing/thin_geometry_aa.h"

namespace tumble {

void Antialiasing::apply(const FrameContext& frame, const Damage& damage, const Visibility& visible, Image& result) {
    if (!options_.transparent)
        copy_opaque(drawn_, damage.changed, result);
    else
        copy_coverage(drawn_, damage.changed, options_.analytic, result);
    if (options_.analytic) {
        blend_analytic_edges(drawn_, edges_.find(frame, damage.drawn.bodies, visible), damage.tiles, result,
                             options_.transparent);
        blend_rods(drawn_, edges_.rods(), damage.tiles, result, options_.transparent);
    }
    if (options_.transparent) make_alpha_straight(damage.changed, result);
}

}  // namespace tumble
