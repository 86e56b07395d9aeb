// Interpolation between keyframes: of bodies, the camera and motors.
#pragma once

namespace tumble {

enum class Interpolation { smooth, linear };

}  // namespace tumble
