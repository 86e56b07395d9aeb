#include "sim/flight/impact_cluster.h"

#include "sim/tuning.h"

#include <algorithm>
#include <numeric>

namespace tumble {
namespace {

template <class T>
bool add_once(std::vector<T>& list, const T& value) {
    if (std::find(list.begin(), list.end(), value) != list.end()) return false;
    list.push_back(value);
    return true;
}

// How near (m) two bodies touch in an impact. Bodies that rest on each other do so within the resting contact's own play.
double touch_distance(const Body& a, const Body& b) {
    const double size = std::min(a.radius, b.radius);
    const double place = std::min(a.position.cwiseAbs().maxCoeff(), b.position.cwiseAbs().maxCoeff());
    const bool held = (a.dynamic() && !a.flying) || (b.dynamic() && !b.flying);
    return (held ? tuning::touch : tuning::impact_touch) * size + 16.0 * tuning::impact_position_rounding * place;
}

}  // namespace

void ImpactCluster::touch(std::uint32_t i, std::uint32_t j, std::vector<Body>& bodies, const Bring& bring) {
    const auto pair = std::minmax(i, j);
    if (!add_once(pairs_, {pair.first, pair.second})) return;
    if (add_once(brought_, j)) bring(j);
    const Body &a = bodies[pair.first], &b = bodies[pair.second];
    const double near = widening_ * touch_distance(a, b), margin = std::max(near, tuning::touch * std::min(a.radius, b.radius));
    const double reach = a.radius + b.radius + margin;
    if ((b.position - a.position).squaredNorm() > reach * reach && std::isfinite(reach)) return;
    const std::size_t first = manifolds_.size();
    scratch_.left_out.clear();
    tumble::collide(a.collider, a.pose(), b.collider, b.pose(), margin, scratch_, manifolds_);
    // Faces that meet at a trace of an angle meet all at once: corner after corner, that trace alone would tell where they go.
    const auto apart = [&](const Manifold& m) {
        return std::all_of(m.points.begin(), m.points.begin() + m.count, [&](const ContactPoint& p) { return p.separation > near; });
    };
    manifolds_.erase(std::remove_if(manifolds_.begin() + std::ptrdiff_t(first), manifolds_.end(), apart), manifolds_.end());
    for (std::size_t k = first; k < manifolds_.size(); ++k) {
        manifolds_[k].a = pair.first;
        manifolds_[k].b = pair.second;
    }
}

void ImpactCluster::expand(std::uint32_t body, std::vector<Body>& bodies, const Neighbourhood& neighbourhood, const Bring& bring) {
    expanded_.push_back(body);
    if (add_once(brought_, body)) bring(body);
    if (!bodies[body].dynamic()) return;
    for (const std::uint32_t other : neighbourhood.moving(body)) touch(body, other, bodies, bring);
    for (const std::uint32_t other : neighbourhood.fixed(body)) touch(body, other, bodies, bring);
}

bool ImpactCluster::resolve(std::uint32_t a, std::uint32_t b, std::vector<Body>& bodies, const Neighbourhood& neighbourhood,
                            const Bring& bring, const ImpactSettings& settings) {
    struck_.clear();
    // Should the manifold miss what the search saw, a wider look finds it.
    for (widening_ = 1.0; widening_ <= 1e4 && struck_.empty(); widening_ *= 1e2) {
        brought_.clear();
        expanded_.clear();
        pairs_.clear();
        manifolds_.clear();
        expand(a, bodies, neighbourhood, bring);
        expand(b, bodies, neighbourhood, bring);
        for (bool grown = true; grown;) {
            grown = false;
            std::sort(manifolds_.begin(), manifolds_.end(), [](const Manifold& l, const Manifold& r) {
                return std::tie(l.a, l.b, l.part) < std::tie(r.a, r.b, r.part);
            });
            make_contacts(manifolds_, bodies, contacts_);
            Island island;
            for (const std::uint32_t k : brought_)
                if (bodies[k].dynamic()) island.bodies.push_back(k);
            std::sort(island.bodies.begin(), island.bodies.end());
            island.contacts.resize(contacts_.size());
            std::iota(island.contacts.begin(), island.contacts.end(), 0u);
            resolve_impacts(island, contacts_, bodies, settings);
            for (const Contact& c : contacts_) {
                if (c.impact <= 0.0) continue;
                for (const std::uint32_t k : {c.a, c.b}) {
                    if (!bodies[k].dynamic() || std::find(expanded_.begin(), expanded_.end(), k) != expanded_.end()) continue;
                    expand(k, bodies, neighbourhood, bring);
                    grown = true;
                }
            }
            if (!grown) break;
            // The blow has come farther than what was looked at: once more from the velocities before it.
            for (const std::uint32_t k : island.bodies) bodies[k].derive();
        }
        for (const Contact& c : contacts_) {
            if (c.impact <= 0.0) continue;
            add_impulse(c, c.impact * c.normal + c.impact_friction, bodies[c.a], bodies[c.b]);
            for (const std::uint32_t k : {c.a, c.b})
                if (bodies[k].dynamic()) add_once(struck_, k);
        }
    }
    std::sort(struck_.begin(), struck_.end());
    for (const std::uint32_t k : brought_)
        if (bodies[k].dynamic()) bodies[k].derive();
    return !struck_.empty();
}

}  // namespace tumble
