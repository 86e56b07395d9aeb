#include "render/antialiasing/antialiasing.h"

#include "render/antialiasing/analytic_aa.h"
#include "render/antialiasing/thin_geometry_aa.h"

namespace tumble {

void Antialiasing::apply(const FrameContext& frame, const Damage& damage, const Visibility& visible, Image& result) {
    copy_opaque(drawn_, damage.changed, result);
    if (!analytic_) return;
    blend_analytic_edges(drawn_, edges_.find(frame, damage.drawn.bodies, visible), damage.tiles, result);
    blend_rods(drawn_, edges_.rods(), damage.tiles, result);
}

}  // namespace tumble
