#include "render/aov/pinhole_camera.h"

namespace tumble {

PinholeCamera::PinholeCamera(const Camera& view)
    : width(view.width()),
      height(view.height()),
      focal(1.0 / view.pixel_size()),
      center_x(0.5 * (view.width() - 1)),
      center_y(0.5 * (view.height() - 1)),
      eye(view.eye()) {
    axes << view.right(), -view.up(), view.forward();
}

}  // namespace tumble
