// Each enum of the interface has the enumerators of an enum of the scene's description, in the same order. Their names
// in scene files are in scene/fields/choices.h.
#pragma once

#include "core/error.h"
#include "scene/fields/choices.h"
#include "tumble/spec.h"

#include <fmt/format.h>

#include <string>

namespace tumble::v0 {

/// Each enumerator has the name of its counterpart, or that of the scene file ("rk4").
template <class Public, class Description, std::size_t n = 0>
consteval bool have_same_enumerators() {
    if constexpr (n == enumerator_count<Description>())
        return enumerator_count<Public>() == n;
    else
        return (enumerator_name<Public(n)>() == enumerator_name<Description(n)>() ||
                enumerator_name<Public(n)>() == tumble::name_of(Description(n))) &&
               have_same_enumerators<Public, Description, n + 1>();
}

template <class Public>
struct Described;  // `type`: the enum of the description; `name`: that of the interface

#define TUMBLE_DESCRIBED(PUBLIC, DESCRIPTION)                 \
    template <>                                               \
    struct Described<PUBLIC> {                                \
        using type = tumble::DESCRIPTION;                     \
        static constexpr const char* name = #PUBLIC;          \
        static_assert(have_same_enumerators<PUBLIC, type>()); \
    }
TUMBLE_DESCRIBED(Integrator, IntegratorKind);
TUMBLE_DESCRIBED(Method, SimulationMethod);
TUMBLE_DESCRIBED(ImpactMode, ImpactMode);
TUMBLE_DESCRIBED(ImpactLaw, ImpactLaw);
TUMBLE_DESCRIBED(ContactSolver, ContactSolverChoice);
TUMBLE_DESCRIBED(RotationForm, RotationForm);
TUMBLE_DESCRIBED(BodyType, BodyType);
TUMBLE_DESCRIBED(Pattern, Pattern);
TUMBLE_DESCRIBED(SoundMaterial, SoundMaterial);
TUMBLE_DESCRIBED(TextureFilter, TextureFilter);
TUMBLE_DESCRIBED(MassFrom, MassFrom);
TUMBLE_DESCRIBED(PairRule, PairRule);
TUMBLE_DESCRIBED(Interpolation, Interpolation);
TUMBLE_DESCRIBED(CameraFit, CameraFit);
TUMBLE_DESCRIBED(ToneCurve, ToneCurve);
TUMBLE_DESCRIBED(SpeedEasing, SpeedEasing);
TUMBLE_DESCRIBED(LightType, LightType);
TUMBLE_DESCRIBED(FieldType, FieldKind);
TUMBLE_DESCRIBED(PairForceType, PairForceKind);
TUMBLE_DESCRIBED(FracturePattern, FracturePattern);
TUMBLE_DESCRIBED(JointType, JointType);
TUMBLE_DESCRIBED(JointFrame, JointFrame);
#undef TUMBLE_DESCRIBED

/// The name in a scene file. Throws InputError for a value without one.
template <class Public>
requires requires { Described<Public>::name; }
std::string name_of(Public value) {
    const std::string_view name = tumble::name_of(typename Described<Public>::type(value));
    if (name.empty())
        throw InputError(
            fmt::format("{} has no enumerator of value {}", Described<Public>::name, static_cast<long long>(value)));
    return std::string(name);
}

}  // namespace tumble::v0
