#include "sim/water/wave_panels.h"

#include "core/deterministic_math.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

constexpr Facets panel_facets{8, 3, true};

/// Panels per wave length, and the fewest that show a wave: a wave on fewer is left out, its push on neighbors is
/// opposite. Simpson's rule on panels of 2/5 of a wave errs by 3e-3 of the largest force of the wave.
constexpr double panels_per_wave = 2.5, fewest_per_wave = 2.0;
constexpr std::size_t most_panels = 16384;  // of a part

/// Lengths of a body in a wave: beside a longer wave the body is short; of a shorter wave it feels nothing, crests and
/// troughs cancel.
constexpr double lengths_in_long_wave = 10.0, shortest_wave = 1.0 / 16.0;

double shortest_felt(const WaterDescription& water, double length) {
    double shortest = infinity;
    for (const WaterWave& wave : water.waves)
        if (wave.length >= shortest_wave * length) shortest = std::min(shortest, wave.length);
    return shortest < infinity ? shortest : length;
}

/// Share of the wet area up to which a cut by the surface counts as none: rounding of a part that is wholly under.
constexpr double least_cut = 1e-6;

/// On panels as a polynomial of the second degree: height over the surface (m), pressure over rho g (m), half of the
/// difference of the squares of the heights of point and surface above the origin (m^2), speed at which the surface
/// rises (m/s).
using Sample = Eigen::Array4d;
struct Of {
    enum : Eigen::Index { over, head, squares, rise };
};

struct Node {
    Sample sample;
    Vec3 flow;  // m/s, of the water
    bool known = false;
};

/// Waves in the frame of a body.
class WaveField {
public:
    /// `shown`: m, shortest wave.
    WaveField(const WavesAround& around, double shown)
        : up_(around.pose.rotation.transpose() * Vec3::UnitY()),
          current_(around.pose.rotation.transpose() * around.current),
          height_(around.pose.position.y() - around.surface.level()) {
        const Pose& pose = around.pose;
        for (const WaterSurface::Wave& wave : around.surface.waves()) {
            if (2.0 * pi < shown * wave.decay) continue;
            const Vec3 k = pose.rotation.transpose() * wave.k;
            waves_.push_back({k,
                              k / wave.decay,
                              wave.amplitude,
                              wave.amplitude * wave.omega,
                              wave.decay,
                              wave.k.dot(pose.position) - wave.rate * around.time + wave.phase,
                              {}});
            crest_ += wave.amplitude;
        }
    }

    const Vec3& up() const { return up_; }
    double height() const { return height_; }
    bool above_crests(const Vec3& point) const { return up_.dot(point) + height_ > crest_; }

    /// Prepares for this many nodes.
    void reset(std::size_t nodes) {
        nodes_.assign(nodes, {});
        decays_.resize(nodes * waves_.size());
    }
    const Node& corner(std::uint32_t n, const Vec3& point) {
        if (!nodes_[n].known)
            find(n, point,
                 [&](std::size_t w, double above) { return exponential(std::min(waves_[w].decay * above, 3.0)); });
        return nodes_[n];
    }
    /// Precondition: its corners `a` and `b` are known. The decay follows from theirs: the surface between them is bent
    /// a little.
    const Node& middle(std::uint32_t n, const Vec3& point, std::uint32_t a, std::uint32_t b) {
        if (nodes_[n].known) return nodes_[n];
        const double mean = 0.5 * (nodes_[a].sample[Of::over] + nodes_[b].sample[Of::over]);
        find(n, point, [&](std::size_t w, double above) {
            const double x = waves_[w].decay * (above - mean);
            return std::sqrt(decay(a, w) * decay(b, w)) * (1.0 + x * (1.0 + x / 2.0 * (1.0 + x / 3.0)));
        });
        return nodes_[n];
    }

private:
    struct Wave {
        Vec3 k, along;
        double amplitude, speed, decay, phase;
        SinCos at;
    };

    double& decay(std::uint32_t node, std::size_t wave) { return decays_[node * waves_.size() + wave]; }

    /// `decay_at`: of a wave, by its index, at a height over the surface.
    template <class DecayAt>
    void find(std::uint32_t n, const Vec3& point, const DecayAt& decay_at) {
        Node& node = nodes_[n];
        node = {Sample::Zero(), current_, true};
        const double y = up_.dot(point);
        double surface = 0.0;
        for (Wave& wave : waves_) {
            wave.at = sincos(wave.phase + wave.k.dot(point));
            surface += wave.amplitude * wave.at.cos;
            node.sample[Of::rise] += wave.speed * wave.at.sin;
        }
        const double above = y + height_ - surface;
        double pressure = -above;
        for (std::size_t w = 0; w < waves_.size(); ++w) {
            const Wave& wave = waves_[w];
            const double e = decay(n, w) = decay_at(w, above);
            pressure += wave.amplitude * (e - 1.0) * wave.at.cos;
            node.flow += wave.speed * e * (wave.at.cos * wave.along + wave.at.sin * up_);
        }
        node.sample[Of::over] = above;
        node.sample[Of::head] = pressure;
        node.sample[Of::squares] = 0.5 * above * (2.0 * y - above);
    }

    Vec3 up_, current_;
    double height_, crest_ = 0.0;  // m, of the origin and of the highest crest, over the level
    std::vector<Wave> waves_;
    std::vector<Node> nodes_;
    std::vector<double> decays_;  // e^(k (y - eta)) of each node, by waves
};

/// Sums over the wet pieces of the panels of a part.
class PartSums {
public:
    /// `height`: m, of the origin over the level.
    PartSums(const HullPart& part, const Vec3& up, double height)
        : made_{&part, {}, {}, {}}, up_(up), height_(height) {}

    /// `middle`: samples at the middles of the edges from corner 0 to 1, 1 to 2, 2 to 0.
    void add(const std::array<Vec3, 3>& corner, const std::array<Sample, 3>& at, const std::array<Sample, 3>& middle,
             const Vec3& area, const Vec3& flow) {
        const double upward = up_.dot(area), size = area.norm();
        if (!(size > 0.0)) return;
        const Sample mean = (middle[0] + middle[1] + middle[2]) / 3.0;
        Vec3 depths = Vec3::Zero(), heads = Vec3::Zero();
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
            // Integrals over a triangle of the six polynomials, each times a coordinate.
            const Sample weight = at[k] / 30.0 - (at[next] + at[last]) / 60.0 +
                                  2.0 / 15.0 * (middle[k] + middle[last]) + middle[next] / 15.0;
            depths += weight[Of::over] * corner[k];
            heads += weight[Of::head] * corner[k];
        }
        volume_ += upward * mean[Of::over];
        moment_ += upward * depths;
        squares_ += upward * mean[Of::squares];
        sum_.force -= mean[Of::head] * area;
        sum_.torque -= heads.cross(area);
        cut_ -= area;
        const Vec3 center = (corner[0] + corner[1] + corner[2]) / 3.0;
        cut_moment_ -= upward * center;
        sum_.wet_area += size;
        sum_.flow += size * flow;
        WetPiece& piece = made_.pieces.emplace_back();
        piece.area = area;
        piece.flow = flow;
        for (std::size_t k = 0; k < 3; ++k) {
            piece.places[k] = 0.5 * (corner[k] + corner[(k + 1) % 3]);
            piece.rises[k] = middle[k][Of::rise];
        }
    }

    WetHull::Part done() {
        if (!(sum_.wet_area > 0.0)) return made_;
        const HullPart& part = *made_.hull;
        sum_.wet = {volume_, moment_ + (squares_ - up_.dot(moment_)) * up_};
        const double cut = up_.dot(cut_);
        if (cut > least_cut * sum_.wet_area) {
            sum_.drag.plane = cut;
            // The water's surface closes the wet part: at its level.
            const Vec3 place = cut_moment_ / cut;
            made_.closing = {cut_, sum_.flow / sum_.wet_area, {place - (up_.dot(place) + height_) * up_}, {}};
        }
        // Pressure turns no ball about its center, and no surface of revolution about its axis: its triangles would.
        if (part.ball > 0.0)
            sum_.torque = part.center.cross(sum_.force);
        else
            sum_.torque -= part.axis.dot(sum_.torque - part.center.cross(sum_.force)) * part.axis;
        made_.still = sum_;
        return std::move(made_);
    }

private:
    WetHull::Part made_;
    Vec3 up_;
    double height_;
    WaveLoad sum_;
    double volume_ = 0.0, squares_ = 0.0;
    Vec3 moment_ = Vec3::Zero(), cut_ = Vec3::Zero(), cut_moment_ = Vec3::Zero();
};

/// The drag of a wet part, for a motion.
class PartDrag {
public:
    PartDrag(const WetHull::Part& part, const FlowPast& motion, const Vec3& up)
        : part_(part), motion_(motion), sum_(part.still) {
        const Vec3 turn = up.cross(motion.angular_velocity);
        const double sinks = up.dot(motion.velocity);
        for (const WetPiece& piece : part.pieces) {
            const double upward = up.dot(piece.area);
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3& place = piece.places[k];
                const double lifts = sinks + turn.dot(place) - piece.rises[k];
                sum_.drag.heave -= upward / 3.0 * lifts * up;
                sum_.drag.roll -= upward / 3.0 * lifts * place.cross(up);
                brake(place, piece.area, 1.0 / 6.0, piece.flow);
            }
        }
        if (part.closing) brake(part.closing->places[0], part.closing->area, 0.5, part.closing->flow);
        sum_.drag.force *= part.hull->scale;
        sum_.drag.torque *= part.hull->scale;
        sum_.grip *= part.hull->scale;
        sum_.turning_grip *= part.hull->scale;
    }
    const WaveLoad& load() const { return sum_; }

private:
    void brake(const Vec3& place, const Vec3& area, double weight, const Vec3& flow) {
        const HullPart& hull = *part_.hull;
        const Vec3& at = hull.ball > 0.0 ? hull.center : place;
        const Vec3 w = motion_.velocity + motion_.angular_velocity.cross(at) - flow;
        const Vec3 past = w - motion_.angular_velocity.dot(hull.axis) * hull.axis.cross(at - hull.center);
        const Vec3 f = element_drag(weight, area, drag_share(hull), w, past);
        sum_.drag.force += f;
        sum_.drag.torque += at.cross(f);
        // Twice the force over the speed: it grows with the square.
        const double grip = 2.0 * weight * std::abs(area.dot(past));
        sum_.grip += grip;
        sum_.turning_grip += grip * (at.squaredNorm() * Mat3::Identity() - at * at.transpose());
    }

    const WetHull::Part& part_;
    const FlowPast& motion_;
    WaveLoad sum_;
};

/// A panel with the samples of its nodes, of which pieces are taken by shares of its corners.
struct SampledPanel {
    std::array<Vec3, 3> corner;
    std::array<Sample, 6> sample;
    Vec3 area, flow;

    Sample at(const Vec3& b) const {
        Sample sum = Sample::Zero();
        for (std::size_t k = 0; k < 3; ++k) {
            const double here = b[Eigen::Index(k)], next = b[Eigen::Index((k + 1) % 3)];
            sum += here * (2.0 * here - 1.0) * sample[k] + 4.0 * here * next * sample[3 + k];
        }
        return sum;
    }
    void add_piece(PartSums& sums, const Vec3& a, const Vec3& b, const Vec3& c) const {
        const std::array<Vec3, 3> shares{a, b, c};
        std::array<Vec3, 3> place;
        std::array<Sample, 3> ends, middle;
        for (std::size_t k = 0; k < 3; ++k) {
            place[k] = shares[k][0] * corner[0] + shares[k][1] * corner[1] + shares[k][2] * corner[2];
            ends[k] = at(shares[k]);
            middle[k] = at(0.5 * (shares[k] + shares[(k + 1) % 3]));
        }
        sums.add(place, ends, middle, a.dot(b.cross(c)) * area, flow);
    }
    /// A quarter of the panel between three of its nodes, as far as it is in the water.
    void add_quarter(PartSums& sums, const std::array<std::size_t, 3>& nodes) const {
        static const std::array<Vec3, 6> shares{Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0), Vec3(0.0, 0.0, 1.0),
                                                Vec3(0.5, 0.5, 0.0), Vec3(0.0, 0.5, 0.5), Vec3(0.5, 0.0, 0.5)};
        std::array<Vec3, 4> kept;
        std::size_t count = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t p = nodes[i], q = nodes[(i + 1) % 3];
            const double at_p = sample[p][Of::over], at_q = sample[q][Of::over];
            if (at_p < 0.0) kept[count++] = shares[p];
            if ((at_p < 0.0) != (at_q < 0.0))
                kept[count++] = shares[p] + at_p / (at_p - at_q) * (shares[q] - shares[p]);
        }
        for (std::size_t k = 2; k < count; ++k) add_piece(sums, kept[0], kept[k - 1], kept[k]);
    }
    void add_to(PartSums& sums) const {
        const auto below =
            std::count_if(sample.begin(), sample.end(), [](const Sample& s) { return s[Of::over] < 0.0; });
        if (below == 0) return;
        if (below == 6)
            return sums.add(corner, {sample[0], sample[1], sample[2]}, {sample[3], sample[4], sample[5]}, area, flow);
        for (const std::array<std::size_t, 3>& nodes :
             {std::array<std::size_t, 3>{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
            add_quarter(sums, nodes);
    }
};

}  // namespace

bool WavePanels::needed(double length, const WaterDescription& water) {
    return std::any_of(water.waves.begin(), water.waves.end(),
                       [&](const WaterWave& wave) { return lengths_in_long_wave * length > wave.length; });
}

WavePanels::WavePanels(const CollisionShape& shape, const WaterDescription& water, double length) {
    const double wave = shortest_felt(water, length);
    shown_ = shortest_wave * length;
    for (HullPart& part : hull_parts(shape, panel_facets)) add(std::move(part), wave);
}

WavePanels::WavePanels(const TriangleMesh& solid, const WaterDescription& water, double length) {
    shown_ = shortest_wave * length;
    HullPart part;
    part.vertices = solid.vertices;
    part.triangles = solid.triangles;
    add(std::move(part), shortest_felt(water, length));
}

void WavePanels::add(HullPart part, double wave) {
    parts_.push_back(divided(std::move(part), wave / panels_per_wave, most_panels));
    shown_ = std::max(shown_, fewest_per_wave * parts_.back().longest);
}

WetHull WavePanels::wet(const WavesAround& around) const {
    WaveField field(around, shown_);
    WetHull hull{field.up(), {}};
    for (const Panels& part : parts_) {
        field.reset(part.nodes.size());
        PartSums sums(part.part, field.up(), field.height());
        for (const HullPanel& panel : part.panels) {
            SampledPanel sampled;
            bool dry = true;
            for (std::size_t k = 0; k < 3; ++k) {
                sampled.corner[k] = part.nodes[panel.nodes[k]];
                dry = dry && field.above_crests(sampled.corner[k]);
            }
            if (dry) continue;
            sampled.area = panel.area;
            sampled.flow = Vec3::Zero();
            for (std::size_t k = 0; k < 3; ++k)
                sampled.sample[k] = field.corner(panel.nodes[k], sampled.corner[k]).sample;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t n = panel.nodes[3 + k];
                const Node& node = field.middle(n, part.nodes[n], panel.nodes[k], panel.nodes[(k + 1) % 3]);
                sampled.sample[3 + k] = node.sample;
                sampled.flow += node.flow / 3.0;
            }
            sampled.add_to(sums);
        }
        hull.parts.push_back(sums.done());
    }
    return hull;
}

WaveLoad WetHull::load(const FlowPast& motion) const {
    WaveLoad sum;
    for (const Part& part : parts) {
        const PartDrag drag(part, motion, up);
        const WaveLoad& one = drag.load();
        sum.wet.volume += one.wet.volume;
        sum.wet.moment += one.wet.moment;
        sum.force += one.force;
        sum.torque += one.torque;
        sum.drag.force += one.drag.force;
        sum.drag.torque += one.drag.torque;
        sum.drag.plane += one.drag.plane;
        sum.drag.heave += one.drag.heave;
        sum.drag.roll += one.drag.roll;
        sum.grip += one.grip;
        sum.turning_grip += one.turning_grip;
        sum.wet_area += one.wet_area;
        sum.flow += one.flow;
    }
    if (sum.wet_area > 0.0) sum.flow /= sum.wet_area;
    return sum;
}

}  // namespace tumble
