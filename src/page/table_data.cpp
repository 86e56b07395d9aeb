#include "page/table_data.h"

#include "page/prediction.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

namespace tumble {
namespace {

using Json = ArrayStore::Json;

constexpr int energy_bits = 40;           // of the mantissa, also of joints: 1e-12 of the value
constexpr int impact_bits = 10;           // of many impacts: 5e-4
constexpr double load_rounding = 1e-9;    // of the weight
constexpr double load_resolution = 1e-7;  // of the largest component

/// Quanta of contacts: of few rows, which a reader may want as numbers, and of many, which are looked at. Of these,
/// forces are squares of whole numbers, as small ones would take most of the bytes otherwise: a median force is right
/// to 2 %.
struct ContactQuanta {
    double place, direction;  // m; of a unit vector
    double force;             // of the median force
    bool squares;
};
constexpr ContactQuanta fine{1e-6, 1e-6, 1e-6, false}, coarse{5e-4, 5e-3, 1.0 / 600.0, true};
constexpr std::int64_t few_contacts = 3000;

template <class Row, class Value>
Json column(const std::vector<Row>& rows, Value&& value, int bits, ArrayStore& arrays) {
    std::vector<double> values;
    values.reserve(rows.size());
    for (const Row& row : rows) values.push_back(value(row));
    return arrays.add(values, bits);
}

template <class Row, class Value>
Json whole_column(const std::vector<Row>& rows, Value&& value, ArrayStore& arrays) {
    std::vector<std::int64_t> values;
    values.reserve(rows.size());
    for (const Row& row : rows) values.push_back(std::int64_t(value(row)));
    return arrays.add(values);
}

/// The median size of the forces that are not zero; 1 without any.
double median_force(const PageRun& run) {
    std::vector<double> forces;
    for (const auto& frame : run.contacts)
        for (const ContactRecord& contact : frame)
            if (contact.normal_force > 0.0) forces.push_back(contact.normal_force);
    if (forces.empty()) return 1.0;
    const auto middle = forces.begin() + std::ptrdiff_t(forces.size() / 2);
    std::nth_element(forces.begin(), middle, forces.end());
    return *middle;
}

/// The moment about the world origin, if friction acts at the contact point too.
Vec3 moment_of(const ImpactRecord& r) {
    const Vec3 moment = r.point.cross(Vec3(r.impulse * r.normal));
    return r.friction.isZero(0.0) ? moment : Vec3(moment + r.point.cross(r.friction));
}

using ContactNumbers = std::array<std::int64_t, 12>;

ContactNumbers numbers_of(const ContactRecord& c, const ContactQuanta& quanta) {
    const auto whole = [](double value, double quantum) { return std::llround(value / quantum); };
    const auto force = [&](double value) {
        const double parts = value / quanta.force;
        return quanta.squares ? std::llround(std::copysign(std::sqrt(std::fabs(parts)), parts)) : std::llround(parts);
    };
    ContactNumbers n{};
    for (int k = 0; k < 3; ++k) {
        n[std::size_t(k)] = whole(c.point[k], quanta.place);
        n[std::size_t(3 + k)] = whole(c.normal[k], quanta.direction);
        n[std::size_t(7 + k)] = force(c.tangential_force[k]);
    }
    n[6] = force(c.normal_force);
    n[10] = std::int64_t(c.state);
    n[11] = std::int64_t(c.features);
    return n;
}

}  // namespace

Json make_energy_data(const PageRun& run, ArrayStore& arrays) {
    constexpr std::pair<const char*, double EnergySample::*> columns[] = {
        {"kinetic_linear", &EnergySample::kinetic_linear},
        {"kinetic_angular", &EnergySample::kinetic_angular},
        {"potential", &EnergySample::potential},
        {"elastic", &EnergySample::elastic},
        {"work", &EnergySample::work},
        {"impact_loss", &EnergySample::impact_loss},
        {"friction_loss", &EnergySample::friction_loss},
        {"contacts", &EnergySample::contacts},
        {"max_penetration", &EnergySample::max_penetration}};
    Json json;
    for (const auto& [name, member] : columns)
        json[name] = column(
            run.energy, [m = member](const EnergySample& sample) { return sample.*m; }, energy_bits, arrays);
    return json;
}

Json make_joint_data(const PageRun& run, ArrayStore& arrays) {
    Json json = Json::object();
    for (const JointColumn& joint : run.joints)
        json[joint.name] = column(
            joint.values, [](double value) { return value; }, energy_bits, arrays);
    return json;
}

Json make_impact_data(const PageRun& run, bool precise, ArrayStore& arrays) {
    Json json{{"count", run.impacts.size()}};
    const auto whole = [&](const char* name, auto&& value) { json[name] = whole_column(run.impacts, value, arrays); };
    const auto real = [&](const char* name, auto&& value) {
        json[name] = column(run.impacts, value, precise ? 52 : impact_bits, arrays);
    };
    const auto vector = [&](const char* name, auto&& value) {
        Json parts = Json::array();
        for (int k = 0; k < 3; ++k)
            parts.push_back(column(
                run.impacts, [&](const PageImpact& i) { return value(i)[k]; }, precise ? 52 : impact_bits, arrays));
        json[name] = std::move(parts);
    };
    json["time"] = column(
        run.impacts, [](const PageImpact& i) { return i.record.when.time; }, 52, arrays);
    whole("exact", [](const PageImpact& i) { return i.record.when.exact; });
    whole("frame", [](const PageImpact& i) { return i.record.when.frame; });
    whole("a", [](const PageImpact& i) { return i.record.a; });
    whole("b", [](const PageImpact& i) { return i.record.b; });
    whole("feature", [](const PageImpact& i) { return i.record.features; });
    whole("pass", [](const PageImpact& i) { return i.record.pass; });
    vector("p", [](const PageImpact& i) { return i.record.point; });
    vector("n", [](const PageImpact& i) { return i.record.normal; });
    vector("f", [](const PageImpact& i) { return i.record.friction; });
    real("v_before", [](const PageImpact& i) { return i.record.speed_before; });
    real("v_after", [](const PageImpact& i) { return i.record.speed_after; });
    real("restitution", [](const PageImpact& i) { return i.record.restitution; });
    real("impulse", [](const PageImpact& i) { return i.record.impulse; });
    if (!precise) return json;
    // The others follow from the rest, to the last bit.
    json["moments"] = Json::array();
    for (std::size_t i = 0; i < run.impacts.size(); ++i)
        if (const ImpactRecord& r = run.impacts[i].record; r.moment != moment_of(r))
            json["moments"].push_back({i, r.moment.x(), r.moment.y(), r.moment.z()});
    whole("event_a", [](const PageImpact& i) { return std::ptrdiff_t(i.event_a); });
    whole("event_b", [](const PageImpact& i) { return std::ptrdiff_t(i.event_b); });
    return json;
}

Json make_contact_data(const PageRun& run, ArrayStore& arrays) {
    std::int64_t rows = 0;
    for (const auto& frame : run.contacts) rows += std::int64_t(frame.size());
    ContactQuanta quanta = rows <= few_contacts ? fine : coarse;
    quanta.force *= median_force(run);
    std::vector<std::int64_t> counts, a, b;
    std::array<std::vector<std::int64_t>, std::tuple_size_v<ContactNumbers>> columns;
    using Pair = std::pair<std::size_t, std::size_t>;
    std::map<Pair, std::vector<ContactNumbers>> before, now;  // of the frame before, and of this one
    for (const auto& frame : run.contacts) {
        counts.push_back(std::int64_t(frame.size()));
        now.clear();
        std::int64_t last_a = 0, last_b = 0;
        for (const ContactRecord& contact : frame) {
            const std::int64_t on_a = contact.a == ContactRecord::nobody ? -1 : std::int64_t(contact.a);
            a.push_back(on_a - last_a);
            b.push_back(std::int64_t(contact.b) - last_b);
            last_a = on_a;
            last_b = std::int64_t(contact.b);
            const Pair pair{contact.a, contact.b};
            std::vector<ContactNumbers>& same = now[pair];
            const auto known = before.find(pair);
            const ContactNumbers numbers = numbers_of(contact, quanta);
            const ContactNumbers reference = known != before.end() && same.size() < known->second.size()
                                                 ? known->second[same.size()]
                                                 : ContactNumbers{};
            for (std::size_t k = 0; k < columns.size(); ++k) columns[k].push_back(numbers[k] - reference[k]);
            same.push_back(numbers);
        }
        std::swap(before, now);
    }
    Json numbers = Json::array();
    for (const auto& column : columns) numbers.push_back(arrays.add(column));
    return {{"quanta", {quanta.place, quanta.direction, quanta.force}},
            {"squares", quanta.squares},
            {"counts", arrays.add(counts)},
            {"a", arrays.add(a)},
            {"b", arrays.add(b)},
            {"numbers", std::move(numbers)}};
}

Json make_load_data(const PageRun& run, ArrayStore& arrays) {
    Json bodies = Json::array();
    std::map<std::size_t, std::array<std::vector<double>, 6>> loads;  // by body: force and moment by frame
    const Vec3& gravity = run.scene.simulation.gravity;
    std::vector<char> more(run.bodies.size(), 0);
    // Forces that cancel still have a moment.
    for (const ForceDescription& force : run.scene.forces) more[force.body] = 1;
    for (std::size_t n = 1; n < run.loads.size(); ++n)
        for (const ExternalLoad& load : run.loads[n]) {
            const Vec3 weight = run.reports[load.body].mass * gravity;
            if ((load.force - weight).norm() > load_rounding * weight.norm()) more[load.body] = 1;
        }
    for (const auto& frame : run.loads)
        for (const ExternalLoad& load : frame)
            if (more[load.body] != 0)
                for (std::size_t k = 0; k < 6; ++k)
                    loads[load.body][k].push_back(k < 3 ? load.force[int(k)] : load.moment[int(k) - 3]);
    for (const auto& [body, components] : loads) {
        Json columns = Json::array();
        for (const std::vector<double>& component : components) {
            double most = 0.0;
            for (const double value : component) most = std::max(most, std::fabs(value));
            const double quantum = most > 0.0 ? load_resolution * most : 1.0;
            std::vector<std::int64_t> whole;
            for (const double value : component) whole.push_back(std::llround(value / quantum));
            const int order = predict(whole);
            columns.push_back({quantum, order, arrays.add(whole)});
        }
        bodies.push_back({body, std::move(columns)});
    }
    return bodies;
}

}  // namespace tumble
