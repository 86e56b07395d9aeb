// Objects that were moved from, and writers that are finished: each of their functions throws an Error.
#include "scenes.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {
namespace {

void expect_error(const std::function<void()>& call, const std::string& said) {
    try {
        call();
        ADD_FAILURE() << "nothing was thrown: " << said;
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_NE(error.message().find(said), std::string::npos) << error.message();
    }
}

/// Moves the object away. All calls throw, and work again once it is assigned to.
template <class Object>
void expect_left(const std::string& type, Object object, const std::vector<std::function<void(Object&)>>& calls) {
    Object other = std::move(object);
    for (const auto& call : calls)
        expect_error([&] { call(object); }, "this " + type + " was moved from: use the object that it was moved to");
    object = std::move(other);
    for (const auto& call : calls) EXPECT_NO_THROW(call(object)) << type;
}

TEST(Lifetime, AMovedObjectSaysSo) {
    const Scene scene(crate_and_ball());
    const Snapshot start = after(scene, 0);
    using Calls = std::vector<std::function<void(Scene&)>>;
    expect_left<Scene>(
        "Scene", Scene(crate_and_ball()),
        Calls{[](Scene& s) { s.title(); }, [](Scene& s) { s.output(); }, [](Scene& s) { s.duration(); },
              [](Scene& s) { s.step(); }, [](Scene& s) { s.steps_per_frame(); }, [](Scene& s) { s.frame_count(); },
              [](Scene& s) { s.body_count(); }, [](Scene& s) { s.body_name(0); }, [](Scene& s) { s.body_type(0); },
              [](Scene& s) { s.find_body("crate"); }, [](Scene& s) { s.joint_count(); }, [](Scene& s) { s.files(); },
              [](Scene& s) { s.data(); }, [](Scene& s) { World w(s); }, [](Scene& s) { FrameSequence f(s); },
              [](Scene& s) { Renderer r(s); }, [](Scene& s) { AovRenderer a(s, {}); },
              [](Scene& s) { Scene(s).title(); }});
    World recording(scene);
    recording.record_contacts();
    expect_left<World>(
        "World", std::move(recording),
        {[](World& w) { w.advance_step(); }, [](World& w) { w.advance_frame(); }, [](World& w) { w.record_contacts(); },
         [](World& w) { w.contacts(); }, [](World& w) { w.snapshot(); }, [](World& w) { w.joints(); },
         [](World& w) { w.energies(); }, [](World& w) { w.properties(0); }});
    expect_left<FrameSequence>("FrameSequence", FrameSequence(scene),
                               {[](FrameSequence& f) { f.frame_count(); }, [](FrameSequence& f) { f.next(); }});
    expect_left<Renderer>("Renderer", Renderer(scene),
                          {[&](Renderer& r) { r.render(start); },
                           [&](Renderer& r) {
                               r.render_blurred({start, start});
                           },
                           [&](Renderer& r) { r.skip(start); }, [](Renderer& r) { r.driver(); }});
    AovSelection motion;
    motion.motion = true;
    expect_left<AovRenderer>("AovRenderer", AovRenderer(scene, motion),
                             {[&](AovRenderer& a) { a.render(start, start); }});
    AovRenderer left(scene, {}), other = std::move(left);
    expect_error([&] { left.render(start); }, "this AovRenderer was moved from");
}

/// Moved from, then finished, then finished again.
template <class Writer>
void expect_ends(const std::string& type, Writer writer, const std::function<void(Writer&)>& add) {
    Writer other = std::move(writer);
    expect_error([&] { add(writer); }, "this " + type + " was moved from");
    expect_error([&] { writer.finish(); }, "this " + type + " was moved from");
    writer = std::move(other);
    add(writer);
    writer.finish();
    for (int again = 0; again < 2; ++again) {
        expect_error([&] { writer.finish(); }, "this " + type + " is finished: make another one for another file");
        expect_error([&] { add(writer); }, "this " + type + " is finished");
    }
}

TEST(Lifetime, AWriterEndsOnce) {
    const TestFolder folder;
    const Scene scene(crate_and_ball());
    World world(scene);
    world.record_contacts();
    const Snapshot now = world.snapshot();
    const FrameContacts contacts = world.contacts();
    const Image image{48, 32, std::vector<std::uint8_t>(48 * 32 * 4, 255)};
    for (const std::string clip : {"c.mp4", "c.gif"})
        expect_ends<ClipWriter>("ClipWriter", ClipWriter(folder / clip, scene.output()),
                                [&](ClipWriter& w) { w.write(image); });
    expect_ends<TrajectoryTable>("TrajectoryTable", TrajectoryTable(folder / "t.csv", scene),
                                 [&](TrajectoryTable& t) { t.add(now); });
    expect_ends<EnergyTable>("EnergyTable", EnergyTable(folder / "e.csv"),
                             [&](EnergyTable& t) { t.add(0, 0.0, world.energies()); });
    for (const std::string ending : {".csv", ".npz"}) {
        expect_ends<ImpactTable>("ImpactTable", ImpactTable(folder / ("i" + ending), scene),
                                 [&](ImpactTable& t) { t.add(contacts); });
        expect_ends<ContactTable>("ContactTable", ContactTable(folder / ("k" + ending), scene),
                                  [&](ContactTable& t) { t.add(0, 0.0, contacts); });
        expect_ends<LoadTable>("LoadTable", LoadTable(folder / ("l" + ending), scene),
                               [&](LoadTable& t) { t.add(0, 0.0, contacts); });
        expect_ends<JointTable>("JointTable", JointTable(folder / ("j" + ending), scene),
                                [&](JointTable& t) { t.add(0, 0.0, {}); });
    }
    EXPECT_EQ(folder.files(), 12u);
}

TEST(Lifetime, AClipWithoutFramesCanGoOn) {
    const TestFolder folder;
    ClipWriter clip(folder / "c.mkv", crate_and_ball().output);
    expect_error([&] { clip.finish(); }, "a clip needs at least one frame");
    clip.write({48, 32, std::vector<std::uint8_t>(48 * 32 * 4, 255)});
    expect_error(
        [&] {
            clip.write({8, 8, std::vector<std::uint8_t>(8 * 8 * 4, 255)});
        },
        "must have the size of the clip");
    clip.finish();
    EXPECT_EQ(folder.files(), 1u);
}

TEST(Lifetime, AFailureEndsAWriter) {
    const Scene scene(crate_and_ball());
    EnergyTable table("/dev/full");
    const Energies energies;
    try {
        for (int row = 0; row < 100000; ++row) table.add(row, 0.0, energies);
        table.finish();
        ADD_FAILURE() << "a full device takes everything";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::run);
    }
    expect_error([&] { table.add(0, 0.0, energies); }, "this EnergyTable failed");
    expect_error([&] { table.finish(); }, "this EnergyTable failed");

    // A row that breaks off, because a body of it does not exist.
    const TestFolder folder;
    {
        LoadTable loads(folder / "l.csv", scene);
        FrameContacts wrong;
        wrong.loads = {{7, {}, {}}};
        EXPECT_THROW(loads.add(0, 0.0, wrong), Error);
        expect_error([&] { loads.finish(); }, "this LoadTable failed");
    }
    EXPECT_EQ(folder.files(), 0u);
}

}  // namespace
}  // namespace tumble
