// Names of enumerators in scene files, one list for each enum, in the order of messages. The reader, the C++ interface,
// pages and motion records have the names from here.
#pragma once

#include "scene/description/description.h"
#include "scene/toml/range.h"

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace tumble {

// Enumerators of an enum whose values count up from 0, by name: for checks at compile time that a list has all of them.

/// Empty for a value without an enumerator.
template <auto value>
consteval std::string_view enumerator_name() {
    std::string_view text =
        __PRETTY_FUNCTION__;  // "... value = tumble::BodyType::fixed; ...", or "= (tumble::BodyType)9"
    text = text.substr(text.find("value = ") + 8);
    text = text.substr(0, text.find_first_of(";]"));
    return text.starts_with('(') ? std::string_view() : text.substr(text.rfind(':') + 1);
}

template <class Enum, std::size_t n = 0>
consteval std::size_t enumerator_count() {
    if constexpr (enumerator_name<Enum(n)>().empty())
        return n;
    else
        return enumerator_count<Enum, n + 1>();
}

/// Frame in which a file gives the places of a joint: the world, or one of its bodies at the start.
enum class JointFrame { world, first, second };

template <class Enum>
inline constexpr auto choices = std::array<Choice<Enum>, 0>{};

template <>
inline constexpr auto choices<IntegratorKind> =
    std::to_array<Choice<IntegratorKind>>({{"symplectic-euler", IntegratorKind::symplectic_euler},
                                           {"explicit-euler", IntegratorKind::explicit_euler},
                                           {"exact", IntegratorKind::exact},
                                           {"splitting", IntegratorKind::splitting},
                                           {"rk4", IntegratorKind::runge_kutta_4}});
template <>
inline constexpr auto choices<SimulationMethod> =
    std::to_array<Choice<SimulationMethod>>({{"tumble", SimulationMethod::tumble}, {"notes", SimulationMethod::notes}});
template <>
inline constexpr auto choices<ImpactMode> = std::to_array<Choice<ImpactMode>>({{"stepped", ImpactMode::stepped},
                                                                               {"exact", ImpactMode::exact}});
template <>
inline constexpr auto choices<ImpactLaw> = std::to_array<Choice<ImpactLaw>>(
    {{"propagating", ImpactLaw::propagating}, {"simultaneous", ImpactLaw::simultaneous}});
template <>
inline constexpr auto choices<ContactSolverChoice> =
    std::to_array<Choice<ContactSolverChoice>>({{"by-island", ContactSolverChoice::by_island},
                                                {"soft", ContactSolverChoice::soft},
                                                {"direct", ContactSolverChoice::direct}});
template <>
inline constexpr auto choices<RotationForm> =
    std::to_array<Choice<RotationForm>>({{"quaternion", RotationForm::quaternion}, {"matrix", RotationForm::matrix}});
template <>
inline constexpr auto choices<PairRule> = std::to_array<Choice<PairRule>>({{"average", PairRule::average},
                                                                           {"minimum", PairRule::minimum},
                                                                           {"multiply", PairRule::multiply},
                                                                           {"maximum", PairRule::maximum},
                                                                           {"geometric", PairRule::geometric}});
template <>
inline constexpr auto choices<BodyType> = std::to_array<Choice<BodyType>>({{"dynamic", BodyType::dynamic},
                                                                           {"fixed", BodyType::fixed},
                                                                           {"kinematic", BodyType::kinematic}});
template <>
inline constexpr auto choices<FieldKind> = std::to_array<Choice<FieldKind>>({{"uniform", FieldKind::uniform},
                                                                             {"point", FieldKind::point},
                                                                             {"vortex", FieldKind::vortex},
                                                                             {"drag", FieldKind::drag}});
template <>
inline constexpr auto choices<PairForceKind> =
    std::to_array<Choice<PairForceKind>>({{"gravity", PairForceKind::gravity},
                                          {"coulomb", PairForceKind::coulomb},
                                          {"spring", PairForceKind::spring},
                                          {"1/r^2", PairForceKind::inverse_square},
                                          {"dipole", PairForceKind::dipole}});
template <>
inline constexpr auto choices<Pattern> = std::to_array<Choice<Pattern>>({{"plain", Pattern::plain},
                                                                         {"panel", Pattern::panel},
                                                                         {"grid", Pattern::grid},
                                                                         {"checker", Pattern::checker},
                                                                         {"stripes", Pattern::stripes},
                                                                         {"dots", Pattern::dots},
                                                                         {"noise", Pattern::noise},
                                                                         {"wood", Pattern::wood},
                                                                         {"marble", Pattern::marble}});
template <>
inline constexpr auto choices<TextureFilter> =
    std::to_array<Choice<TextureFilter>>({{"linear", TextureFilter::linear}, {"nearest", TextureFilter::nearest}});
template <>
inline constexpr auto choices<LightType> =
    std::to_array<Choice<LightType>>({{"sun", LightType::sun}, {"point", LightType::point}, {"spot", LightType::spot}});
template <>
inline constexpr auto choices<ToneCurve> = std::to_array<Choice<ToneCurve>>({{"filmic", ToneCurve::filmic},
                                                                             {"linear", ToneCurve::linear}});
template <>
inline constexpr auto choices<SoundMaterial> = std::to_array<Choice<SoundMaterial>>({{"wood", SoundMaterial::wood},
                                                                                     {"metal", SoundMaterial::metal},
                                                                                     {"glass", SoundMaterial::glass},
                                                                                     {"stone", SoundMaterial::stone},
                                                                                     {"plastic",
                                                                                      SoundMaterial::plastic},
                                                                                     {"rubber", SoundMaterial::rubber},
                                                                                     {"none", SoundMaterial::none}});
template <>
inline constexpr auto choices<MassFrom> =
    std::to_array<Choice<MassFrom>>({{"solid", MassFrom::solid}, {"hull", MassFrom::hull}, {"shell", MassFrom::shell}});
template <>
inline constexpr auto choices<CurvedKind> = std::to_array<Choice<CurvedKind>>({{"capsule", CurvedKind::capsule},
                                                                               {"cylinder", CurvedKind::cylinder},
                                                                               {"cone", CurvedKind::cone},
                                                                               {"ellipsoid", CurvedKind::ellipsoid}});
template <>
inline constexpr auto choices<Interpolation> =
    std::to_array<Choice<Interpolation>>({{"smooth", Interpolation::smooth}, {"linear", Interpolation::linear}});
template <>
inline constexpr auto choices<CameraFit> = std::to_array<Choice<CameraFit>>({{"motion", CameraFit::motion},
                                                                             {"start", CameraFit::start}});
template <>
inline constexpr auto choices<FrameCorner> =
    std::to_array<Choice<FrameCorner>>({{"top-left", FrameCorner::top_left},
                                        {"top-right", FrameCorner::top_right},
                                        {"bottom-left", FrameCorner::bottom_left},
                                        {"bottom-right", FrameCorner::bottom_right}});
template <>
inline constexpr auto choices<SpeedEasing> = std::to_array<Choice<SpeedEasing>>({{"smooth", SpeedEasing::smooth},
                                                                                 {"linear", SpeedEasing::linear},
                                                                                 {"step", SpeedEasing::step}});
template <>
inline constexpr auto choices<JointType> = std::to_array<Choice<JointType>>({{"fixed", JointType::fixed},
                                                                             {"hinge", JointType::hinge},
                                                                             {"ball", JointType::ball},
                                                                             {"slider", JointType::slider},
                                                                             {"universal", JointType::universal},
                                                                             {"cylindrical", JointType::cylindrical},
                                                                             {"planar", JointType::planar},
                                                                             {"distance", JointType::distance},
                                                                             {"6dof", JointType::six_dof},
                                                                             {"gear", JointType::gear}});
template <>
inline constexpr auto choices<JointFrame> = std::to_array<Choice<JointFrame>>({{"world", JointFrame::world},
                                                                               {"first", JointFrame::first},
                                                                               {"second", JointFrame::second}});
template <>
inline constexpr auto choices<PlotPlace> = std::to_array<Choice<PlotPlace>>({{"inset", PlotPlace::inset},
                                                                             {"beside", PlotPlace::beside},
                                                                             {"below", PlotPlace::below}});
template <>
inline constexpr auto choices<ArrowQuantity> =
    std::to_array<Choice<ArrowQuantity>>({{"force", ArrowQuantity::force},
                                          {"impulse", ArrowQuantity::impulse},
                                          {"velocity", ArrowQuantity::velocity},
                                          {"omega", ArrowQuantity::omega},
                                          {"momentum", ArrowQuantity::momentum},
                                          {"angular-momentum", ArrowQuantity::angular_momentum},
                                          {"torque", ArrowQuantity::torque}});

template <>
inline constexpr auto choices<FracturePattern> =
    std::to_array<Choice<FracturePattern>>({{"voronoi", FracturePattern::voronoi},
                                            {"radial", FracturePattern::radial},
                                            {"slabs", FracturePattern::slabs},
                                            {"bricks", FracturePattern::bricks}});

/// True for enums with names, which are then complete.
template <class Enum>
concept Named = !choices<Enum>.empty() && choices<Enum>.size() == enumerator_count<Enum>();

/// The name of an enumerator; empty for a value that has none.
template <Named Enum>
constexpr std::string_view name_of(Enum value) {
    for (const Choice<Enum>& choice : choices<Enum>)
        if (choice.value == value) return choice.name;
    return {};
}

/// The integrators of a method: that of the notes has the first two.
inline std::span<const Choice<IntegratorKind>> integrator_choices(SimulationMethod method) {
    return std::span(choices<IntegratorKind>)
        .first(method == SimulationMethod::notes ? 2 : choices<IntegratorKind>.size());
}

}  // namespace tumble
