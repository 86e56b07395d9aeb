#include "page/key_path.h"

#include "page/motion_segment.h"

#include <cmath>

namespace tumble {
namespace {

constexpr double same_time = 1e-9;  // s
constexpr std::size_t no_frame = SIZE_MAX;

/// A moment of the body, with its velocities before and after it.
struct Node {
    Moment in, out;
    std::size_t frame = no_frame;
    bool impact = false;
};

class Search {
public:
    Search(const BodyRecord& body, const KeySearch& search) : body_(body), search_(search) {
        add_nodes();
        path_.frames.push_back(0);
        for (std::size_t from = 0; from + 1 < nodes_.size() && path_.frames.size() <= search_.most;)
            from = add_segment(from);
    }

    std::optional<KeyPath> path() && {
        if (path_.frames.size() > search_.most) return std::nullopt;
        return std::move(path_);
    }

private:
    void add_nodes();
    void add_impact(const BodyEvent& event);
    std::size_t add_segment(std::size_t from);
    std::size_t longest(std::size_t from, std::size_t limit) const;
    bool fits(std::size_t from, std::size_t to) const;
    MotionErrors errors(std::size_t from, std::size_t to, const MotionErrors& limit) const;

    const BodyRecord& body_;
    const KeySearch& search_;
    std::vector<Node> nodes_;
    KeyPath path_;
};

void Search::add_nodes() {
    std::size_t next = 0;
    const auto add_impacts_until = [&](double time) {
        for (; next < body_.events.size() && body_.events[next].time <= time; ++next) add_impact(body_.events[next]);
    };
    for (std::size_t n = 0; n < body_.samples.size(); ++n) {
        const BodySample& sample = body_.samples[n];
        const double time = double(n) / search_.fps;
        add_impacts_until(time - same_time);
        const Moment moment{time, sample.position, sample.rotation, sample.velocity, sample.angular_velocity};
        nodes_.push_back({moment, moment, n, false});
        add_impacts_until(time + same_time);
    }
}

/// An impact at the time of the moment before adds its velocities to that.
void Search::add_impact(const BodyEvent& event) {
    const StruckBody& body = event.body;
    const Moment before{event.time, body.position, body.rotation, body.velocity_before, body.angular_velocity_before};
    Node* last = nodes_.empty() ? nullptr : &nodes_.back();
    if (!last || event.time - last->in.time > (last->frame == no_frame ? 0.0 : same_time)) {
        nodes_.push_back({before, before, no_frame, true});
        last = &nodes_.back();
    } else if (!last->impact) {
        last->in.velocity = body.velocity_before;
        last->in.angular_velocity = body.angular_velocity_before;
    }
    last->impact = true;
    last->out.velocity = body.velocity_after;
    last->out.angular_velocity = body.angular_velocity_after;
}

MotionErrors Search::errors(std::size_t from, std::size_t to, const MotionErrors& limit) const {
    MotionErrors errors;
    const MotionSegment segment(nodes_[from].out, nodes_[to].in, search_.inertia);
    for (std::size_t i = from + 1; i < to; ++i) {
        const Moment found = segment.at(nodes_[i].in.time);
        errors.add(body_.samples[nodes_[i].frame],
                   {found.position, found.rotation, found.velocity, found.angular_velocity, false});
        if (errors.position > limit.position || errors.rotation > limit.rotation || errors.velocity > limit.velocity ||
            errors.angular_velocity > limit.angular_velocity)
            break;
    }
    return errors;
}

bool Search::fits(std::size_t from, std::size_t to) const {
    const MotionErrors& most = page_key_tolerance;
    const MotionErrors found = errors(from, to, most);
    return found.position <= most.position && found.rotation <= most.rotation && found.velocity <= most.velocity &&
           found.angular_velocity <= most.angular_velocity;
}

/// The end of the longest segment found: the whole at first, because most flights are one segment.
std::size_t Search::longest(std::size_t from, std::size_t limit) const {
    if (fits(from, limit)) return limit;
    std::size_t good = from + 1, bad = limit;
    for (std::size_t step = 1; good + step < bad; step *= 2) {
        if (!fits(from, good + step)) {
            bad = good + step;
            break;
        }
        good += step;
    }
    while (good + 1 < bad) {
        const std::size_t middle = good + (bad - good) / 2;
        (fits(from, middle) ? good : bad) = middle;
    }
    return good;
}

/// Adds a segment and returns its end.
std::size_t Search::add_segment(std::size_t from) {
    std::size_t limit = from + 1;
    while (limit + 1 < nodes_.size() && !nodes_[limit].impact) ++limit;
    const std::size_t end = longest(from, limit);
    path_.errors.add(errors(from, end, {infinity, infinity, infinity, infinity}));
    // A frame at the time of an impact has the state before it or after it: it is kept.
    if (nodes_[end].frame != no_frame) path_.frames.push_back(nodes_[end].frame);
    return end;
}

}  // namespace

std::optional<KeyPath> find_keys(const BodyRecord& body, const KeySearch& search) {
    return Search(body, search).path();
}

}  // namespace tumble
