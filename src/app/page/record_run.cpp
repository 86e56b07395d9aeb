#include "app/page/record_run.h"

#include "core/error.h"
#include "page/page_recorder.h"
#include "presimulation/motion_camera.h"
#include "sim/world.h"

#include <vector>

namespace tumble {
namespace {

struct ProgressObserver : SurveyObserver {
    explicit ProgressObserver(const std::function<void(std::int64_t)>& to_call) : progress(to_call) {}
    void see(const Snapshot&, const Survey&, const ContactRecords*) override {
        if (++frames; progress) progress(frames);
    }
    const std::function<void(std::int64_t)>& progress;
    std::int64_t frames = 0;
};

}  // namespace

PageRun record_run(const SceneDescription& unframed, const RecordSettings& settings, Interrupt& interrupt) {
    const SceneDescription scene = framed(unframed, settings.threads, [&] {
        if (interrupt.pending()) throw Interrupted();
    });
    World world(scene, settings.threads);
    world.record_contacts();
    PageRecorder recorder(scene, {.label = settings.label, .plot = settings.plot}, world);
    ProgressObserver progress(settings.progress);
    std::vector<SurveyObserver*> observers{&recorder, &progress};
    observers.insert(observers.end(), settings.observers.begin(), settings.observers.end());
    survey(world, {scene.frame_count(), 1}, observers, interrupt);
    return recorder.finish();
}

}  // namespace tumble
