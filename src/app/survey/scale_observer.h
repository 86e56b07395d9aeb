// The sizes of arrows over a clip, for their scales.
#pragma once

#include "app/survey/survey.h"
#include "overlay/overlay_scales.h"

namespace tumble {

struct ScaleObserver : SurveyObserver {
    explicit ScaleObserver(const SceneDescription& scene) : sizes(scene) {}
    void see(const Snapshot& snapshot, const Survey&, const ContactRecords* records) override {
        sizes.add(snapshot, records);
    }
    ScaleSurvey sizes;
};

}  // namespace tumble
