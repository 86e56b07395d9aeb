// Files of checkpoints with a right checksum and wrong values: a state, or a motion, is read and gone on from, or
// refused by an InputError. Layouts change, so that an input is no file but a recipe: a scene, a time, and edits of the
// file of that state; the checksum is made after them.
#include "app/checkpoints/checkpoint_file.h"
#include "app/checkpoints/clip_state.h"
#include "app/checkpoints/frame_record.h"
#include "checkpoint_scenes.h"
#include "core/check.h"
#include "core/error.h"
#include "output/file_bytes.h"
#include "scene/load.h"
#include "sim/checkpoint/archive.h"
#include "sim/frames/frame_sequence.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace tumble;
using Bytes = std::vector<std::byte>;

constexpr int times[] = {0, 1, 9, 40};  // frames
constexpr int seen_frames = 2;          // after the state
constexpr std::size_t sum_size = 8;

Bytes bytes_of(const CheckpointWriter& writer) { return {writer.bytes().begin(), writer.bytes().end()}; }

CheckpointHeader header() {
    CheckpointHeader header;
    header.program = "fuzz";
    header.kind = "state";
    return header;
}

struct Base {
    SceneDescription scene;
    bool records = false;
    std::vector<Bytes> states, motions;  // by time: contents of files
};

struct Run {
    explicit Run(const Base& base) : world(base.scene, 1) {
        if (base.records) world.record_contacts();
    }
    World world;
    FrameSequence frames{world, Shutter::of(0.0, 1)};
};

ClipState state_of(const Run& run) {
    CheckpointWriter writer;
    run.world.save(writer);
    writer.keep(run.frames);
    ClipState state;
    state.panels.resize(1);
    state.panels[0].simulation = bytes_of(writer);
    return state;
}

Base make_base(const testing::CheckpointScene& from) {
    Base base{parse_scene(from.text, "/nowhere/scene.toml"), from.records, {}, {}};
    Run run(base);
    FrameRecorder recorder(from.records ? MotionDetail::states : MotionDetail::poses);
    int frame = 0;
    for (const int time : times) {
        for (; frame < time; ++frame) recorder.add(run.frames.next(), run.frames.records());
        run.frames.reach_next();
        CheckpointWriter writer;
        writer.keep(state_of(run));
        base.states.push_back(bytes_of(writer));
        if (time > 0) base.motions.push_back(recorder.take());
    }
    return base;
}

const Base& base_of(std::size_t scene) {
    static std::map<std::size_t, Base> bases;
    const auto found = bases.find(scene);
    return found != bases.end() ? found->second
                                : bases.emplace(scene, make_base(testing::checkpoint_scenes[scene])).first->second;
}

/// The bytes of an input, zeros behind its end.
class Recipe {
public:
    explicit Recipe(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
    bool at_end() const { return bytes_.empty(); }
    template <class T>
    T take() {
        T value{};
        const std::size_t count = std::min(sizeof value, bytes_.size());
        std::memcpy(&value, bytes_.data(), count);
        bytes_ = bytes_.subspan(count);
        return value;
    }

private:
    std::span<const std::uint8_t> bytes_;
};

template <class T>
void put(Bytes& file, std::size_t at, T value) {
    std::memcpy(file.data() + at, &value, std::min(sizeof value, file.size() - at));
}

constexpr double numbers[] = {0.0,
                              -1.0,
                              1e-300,
                              1e300,
                              -1e300,
                              1e18,
                              1e9,
                              -1e9,
                              1e-9,
                              0.5,
                              1e38,
                              3.0,
                              1e160,
                              std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::quiet_NaN(),
                              -0.0};
constexpr std::uint64_t integers[] = {0,
                                      1,
                                      2,
                                      3,
                                      4,
                                      5,
                                      7,
                                      8,
                                      255,
                                      0x7fffffff,
                                      0x80000000,
                                      0xffffffff,
                                      1u << 16,
                                      0x7fffffffffffffff,
                                      0x8000000000000000,
                                      0xffffffffffffffff};

/// One edit of 1 + 3 + 8 bytes; the sum at the end is left alone.
void edit(Bytes& file, Recipe& recipe) {
    const auto way = recipe.take<std::uint8_t>();
    const std::size_t low = recipe.take<std::uint16_t>(), high = recipe.take<std::uint8_t>();
    const auto value = recipe.take<std::uint64_t>();
    if (file.size() <= sum_size) return;
    const std::size_t size = file.size() - sum_size, at = (high << 16 | low) % size;
    const auto place = file.begin() + std::ptrdiff_t(at);
    switch (way % 9) {
        case 0:
            return put(file, at, std::uint8_t(value));
        case 1:
            return put(file, at, std::uint32_t(value));
        case 2:
            return put(file, at, value);
        case 3:
            return put(file, at, numbers[value % std::size(numbers)]);
        case 4:
            return put(file, at, std::uint32_t(integers[value % std::size(integers)]));
        case 5:
            return put(file, at, integers[value % std::size(integers)]);
        case 6: {
            file.erase(place, place + std::ptrdiff_t(std::min<std::size_t>(value % 64, size - at)));
            return;
        }
        case 7: {  // the bytes of another place
            const std::size_t from = value % size, count = std::min({std::size_t(8), size - from, size - at});
            std::memmove(file.data() + at, file.data() + from, count);
            return;
        }
        default: {
            const Bytes again(place, place + std::ptrdiff_t(std::min<std::size_t>(value % 64, size - at)));
            file.insert(place, again.begin(), again.end());
            return;
        }
    }
}

/// Content that was edited with its file around it.
Bytes content_of(std::span<const std::byte> content, Recipe& recipe) {
    Bytes file = checkpoint_bytes(header(), content);
    while (!recipe.at_end()) edit(file, recipe);
    if (file.size() >= sum_size)
        put(file, file.size() - sum_size, crc64(std::span(file).first(file.size() - sum_size)));
    return checkpoint_content("/nowhere/checkpoint.tumble", file, header());
}

void go_on(const Base& base, std::span<const std::byte> content) {
    CheckpointReader file(content);
    ClipState state;
    file.keep(state);
    if (state.panels.empty()) CheckpointReader::fail("has no panel");
    CheckpointReader reader(state.panels[0].simulation);
    Run run(base);
    run.world.restore(reader);
    reader.keep(run.frames);
    if (!reader.at_end()) CheckpointReader::fail("is longer than its content");
    try {
        run.world.measure();
        for (int n = 0; n < seen_frames; ++n) run.frames.next();
        run.world.measure();
        CheckpointWriter writer;
        run.world.save(writer);
    } catch (const RunError&) {  // of numbers that no longer are
    }
}

void see(const Base& base, Bytes content) {
    FrameReader reader(std::move(content), base.scene.bodies.size());
    while (!reader.at_end()) reader.next();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Recipe recipe(std::span(data, size));
    const auto scene = recipe.take<std::uint8_t>(), time = recipe.take<std::uint8_t>();
    const Base& base = base_of(scene % std::size(testing::checkpoint_scenes));
    const bool motion = (time & 0x80) != 0;
    try {
        const std::vector<Bytes>& contents = motion ? base.motions : base.states;
        const Bytes content = content_of(contents[time % contents.size()], recipe);
        motion ? see(base, content) : go_on(base, content);
    } catch (const InputError& error) {
        for (const char c : std::string_view(error.what()))
            TUMBLE_CHECK_EQ(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, true);
    }
    return 0;
}
