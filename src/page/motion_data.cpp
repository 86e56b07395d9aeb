#include "page/motion_data.h"

#include "page/key_path.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

namespace tumble {
namespace {

// At level 0 positions are right within 1e-6 m and rotations within 1e-5 rad; each level divides by 4. A stepped
// motion's velocities need no more digits; in exact mode they lead to impacts between frames. Coarser levels are for
// pages that would be too large to open otherwise, as of a thousand bodies: their errors are stated, as all are.
constexpr Quanta level_0{1e-6, 1e-5, 2e-3, 4e-3}, level_0_exact{1e-6, 1e-5, 5e-5, 1e-4};
constexpr int finest_level = 8, coarsest_level = -5;
constexpr double most_bytes = 600e3;             // of a motion, compressed: coarser than level 0 only above
constexpr double bytes_of_key = 96.0;            // a frame, compressed
constexpr double worth_of_keys = 400.0;          // bytes of a body that exact motion between frames may cost more
constexpr std::size_t most_struck_times = 6000;  // of all bodies, 8 bytes each
constexpr std::size_t sample_numbers = 13, event_numbers = 19;

using Json = ArrayStore::Json;

Quanta at_level(const Quanta& quanta, int level) {
    const double finer = std::ldexp(1.0, -2 * level);
    // Coarse velocities show as arrows that tremble, earlier than coarse places do.
    const double velocities = std::ldexp(1.0, level < 0 ? -level : -2 * level);
    return {finer * quanta.position, finer * quanta.rotation, velocities * quanta.velocity,
            velocities * quanta.angular_velocity};
}

/// How many bits the channels of a body need, at the finest level and roughly at others.
class Widths {
public:
    void add(const FrameChannels& channels) {
        for (const std::int64_t value : channels.values) ++counts_[std::size_t(std::bit_width(zigzag(value)))];
    }
    double bytes(int level) const {
        double bits = 0.0;
        for (int width = 0; width <= 64; ++width) {
            // Differences of rounded numbers are one bit or so, even where differences of exact ones are nearly zero.
            const int left = std::max(1, width - 2 * (finest_level - level));
            bits += double(counts_[std::size_t(width)]) * (width > 0 ? left + bits_of_lengths : bits_of_zero);
        }
        return bytes_per_bit * bits;
    }

private:
    static constexpr double bits_of_lengths = 0.7, bits_of_zero = 0.1;
    static constexpr double bytes_per_bit = 1.3 / 8.0;  // measured: deflate works with whole bytes
    std::array<std::int64_t, 65> counts_{};
};

bool stands_still(const BodyRecord& body) {
    const BodySample& first = body.samples.front();
    return first.velocity.isZero(0.0) && first.angular_velocity.isZero(0.0) && body.events.empty() &&
           std::ranges::all_of(body.samples, [&](const BodySample& sample) {
               return sample.position == first.position && sample.rotation.coeffs() == first.rotation.coeffs();
           });
}

/// Numbers by component: all x, then all y, and so on.
class Columns {
public:
    explicit Columns(std::size_t count) : columns_(count) {}
    void add(std::initializer_list<double> head, std::initializer_list<const Vec3*> vectors) {
        std::size_t next = 0;
        for (const double value : head) columns_[next++].push_back(value);
        for (const Vec3* v : vectors)
            for (int c = 0; c < 3; ++c) columns_[next++].push_back((*v)[c]);
    }
    std::vector<double> all() const {
        std::vector<double> values;
        for (const auto& column : columns_) values.insert(values.end(), column.begin(), column.end());
        return values;
    }

private:
    std::vector<std::vector<double>> columns_;
};

void add_sample(Columns& columns, const BodySample& s) {
    const Quat& q = s.rotation;
    columns.add({q.w(), q.x(), q.y(), q.z()}, {&s.position, &s.velocity, &s.angular_velocity});
}

class Writer {
public:
    Writer(const PageRun& run, std::size_t budget, bool events, ArrayStore& arrays)
        : run_(run), budget_(double(budget)), events_(events), arrays_(arrays), plans_(run.bodies.size()) {}

    MotionData write() {
        for (std::size_t i = 0; i < plans_.size(); ++i) plan(i);
        choose_level();
        MotionData data;
        data.json["still"] = still();
        data.json["keys"] = keys();
        data.json["frames"] = frames();
        data.json["events"] = events();
        data.json["struck"] = struck_times();
        data.json["asleep"] = asleep();
        if (Json found = absent(); !found.empty()) data.json["absent"] = std::move(found);
        data.errors = errors_;
        data.json["error"] = {{"position", errors_.position},
                              {"rotation", errors_.rotation},
                              {"velocity", errors_.velocity},
                              {"angular_velocity", errors_.angular_velocity}};
        return data;
    }

private:
    enum class Kind { still, keys, frames };
    struct Plan {
        Kind kind = Kind::still;
        std::optional<KeyPath> keys;
        double key_bytes = infinity;
        Widths widths;
    };

    void plan(std::size_t body);
    void choose_level();
    /// True if states at impacts follow from the frames around: exact mode, with the times of all impacts.
    bool fine_velocities() const { return run_.scene.simulation.impacts == ImpactMode::exact && knows_times(); }
    bool knows_times() const;
    Quanta quanta(int level) const { return at_level(fine_velocities() ? level_0_exact : level_0, level); }
    std::vector<std::size_t> bodies_of(Kind kind) const;
    Json still();
    Json keys();
    Json frames();
    Json events();
    Json struck_times();
    Json asleep() const;
    Json absent() const;

    const PageRun& run_;
    const double budget_;
    const bool events_;
    ArrayStore& arrays_;
    std::vector<Plan> plans_;  // by body
    int level_ = finest_level;
    MotionErrors errors_;
};

void Writer::plan(std::size_t index) {
    const BodyRecord& body = run_.bodies[index];
    Plan& plan = plans_[index];
    if (body.samples.size() < 2 || stands_still(body)) return;
    plan.kind = Kind::frames;
    plan.widths.add(encode_frames(body.samples, quanta(finest_level), 1.0 / run_.scene.output.fps));
    if (!body.all_events || (!events_ && !body.events.empty())) return;
    const bool dynamic = run_.scene.bodies[index].type == BodyType::dynamic;
    // More keys than those would not be chosen at any level: the finest one has the most bytes.
    const auto most = std::size_t((plan.widths.bytes(finest_level) + worth_of_keys) / bytes_of_key);
    const Mat3 inertia = dynamic ? run_.reports[index].inertia : Mat3(Mat3::Zero());
    plan.keys = find_keys(body, {run_.scene.output.fps, inertia, most});
    if (plan.keys) plan.key_bytes = bytes_of_key * double(plan.keys->frames.size());
}

/// The finest level whose data fit into the budget, each body in its smaller form.
void Writer::choose_level() {
    const auto as_keys = [&](const Plan& plan) { return plan.key_bytes <= plan.widths.bytes(level_) + worth_of_keys; };
    for (level_ = finest_level; level_ > coarsest_level; --level_) {
        double all = 0.0;
        for (const Plan& plan : plans_)
            if (plan.kind != Kind::still) all += as_keys(plan) ? plan.key_bytes : plan.widths.bytes(level_);
        if (all <= (level_ > 0 ? budget_ : most_bytes)) break;
    }
    for (Plan& plan : plans_)
        if (plan.kind != Kind::still && as_keys(plan)) plan.kind = Kind::keys;
}

std::vector<std::size_t> Writer::bodies_of(Kind kind) const {
    std::vector<std::size_t> bodies;
    for (std::size_t i = 0; i < plans_.size(); ++i)
        if (plans_[i].kind == kind) bodies.push_back(i);
    return bodies;
}

Json Writer::still() {
    const std::vector<std::size_t> bodies = bodies_of(Kind::still);
    Columns columns(sample_numbers);
    for (const std::size_t i : bodies) add_sample(columns, run_.bodies[i].samples.front());
    return {{"bodies", bodies}, {"values", arrays_.add(columns.all())}};
}

Json Writer::keys() {
    const std::vector<std::size_t> bodies = bodies_of(Kind::keys);
    Columns columns(sample_numbers);
    std::vector<std::int64_t> counts, frames;
    for (const std::size_t i : bodies) {
        const KeyPath& path = *plans_[i].keys;
        errors_.add(path.errors);
        counts.push_back(std::int64_t(path.frames.size()));
        for (std::size_t k = 0; k < path.frames.size(); ++k) {
            frames.push_back(std::int64_t(path.frames[k] - (k > 0 ? path.frames[k - 1] : 0)));
            add_sample(columns, run_.bodies[i].samples[path.frames[k]]);
        }
    }
    return {{"bodies", bodies},
            {"counts", arrays_.add(counts)},
            {"frames", arrays_.add(frames)},
            {"values", arrays_.add(columns.all())}};
}

Json Writer::frames() {
    const std::vector<std::size_t> bodies = bodies_of(Kind::frames);
    const Quanta q = quanta(level_);
    std::vector<std::int64_t> values, orders;
    for (const std::size_t i : bodies) {
        const FrameChannels channels = encode_frames(run_.bodies[i].samples, q, 1.0 / run_.scene.output.fps);
        values.insert(values.end(), channels.values.begin(), channels.values.end());
        orders.insert(orders.end(), channels.orders.begin(), channels.orders.end());
        errors_.add(channels.errors);
    }
    return {{"bodies", bodies},
            {"quanta", {q.position, q.rotation, q.velocity, q.angular_velocity}},
            {"orders", arrays_.add(orders)},
            {"values", arrays_.add(values)}};
}

Json Writer::events() {
    if (!events_) return nullptr;
    std::vector<std::int64_t> counts, exact;
    std::vector<double> times;
    Columns columns(event_numbers);
    for (const BodyRecord& body : run_.bodies) {
        counts.push_back(std::int64_t(body.events.size()));
        for (const BodyEvent& event : body.events) {
            const StruckBody& b = event.body;
            times.push_back(event.time);
            exact.push_back(event.exact);
            columns.add({b.rotation.w(), b.rotation.x(), b.rotation.y(), b.rotation.z()},
                        {&b.position, &b.velocity_before, &b.angular_velocity_before, &b.velocity_after,
                         &b.angular_velocity_after});
        }
    }
    return {{"counts", arrays_.add(counts)},
            {"times", arrays_.add(times)},
            {"exact", arrays_.add(exact)},
            {"values", arrays_.add(columns.all())}};
}

bool Writer::knows_times() const {
    std::size_t events = 0;
    for (const BodyRecord& body : run_.bodies) {
        if (!body.all_events) return false;
        events += body.events.size();
    }
    return events <= most_struck_times;
}

/// Without events: the times when each body is struck.
Json Writer::struck_times() {
    if (events_ || !fine_velocities()) return nullptr;
    std::vector<std::int64_t> counts;
    std::vector<double> times;
    for (const BodyRecord& body : run_.bodies) {
        counts.push_back(std::int64_t(body.events.size()));
        for (const BodyEvent& event : body.events) times.push_back(event.time);
    }
    return {{"counts", arrays_.add(counts)}, {"times", arrays_.add(times)}};
}

/// Frames where each body that sleeps falls asleep and wakes up, in turn.
Json Writer::asleep() const {
    Json all = Json::array();
    for (std::size_t i = 0; i < run_.bodies.size(); ++i) {
        bool sleeps = false;
        Json frames = Json::array();
        for (std::size_t n = 0; n < run_.bodies[i].samples.size(); ++n)
            if (run_.bodies[i].samples[n].asleep != sleeps) {
                sleeps = !sleeps;
                frames.push_back(n);
            }
        if (!frames.empty()) all.push_back({i, std::move(frames)});
    }
    return all;
}

/// Frames where bodies vanish and appear in turn: pieces, and bodies that break.
Json Writer::absent() const {
    Json all = Json::array();
    for (std::size_t i = 0; i < run_.bodies.size(); ++i)
        if (!run_.bodies[i].absent_from.empty()) all.push_back({i, run_.bodies[i].absent_from});
    return all;
}

}  // namespace

MotionData make_motion_data(const PageRun& run, std::size_t budget, bool events, ArrayStore& arrays) {
    return Writer(run, budget, events, arrays).write();
}

}  // namespace tumble
