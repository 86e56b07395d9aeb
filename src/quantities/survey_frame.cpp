#include "quantities/survey_frame.h"

namespace tumble {

Survey::Survey(const World& world, const SurveyNeeds& needs) {
    if (needs.measurement) measurement = world.measure();
    if (needs.joints) joints = world.joint_states();
}

SurveyNeeds needs_of(std::span<SurveyObserver* const> observers) {
    SurveyNeeds needs;
    for (const SurveyObserver* observer : observers) needs = needs | observer->needs();
    return needs;
}

}  // namespace tumble
