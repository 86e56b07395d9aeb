#include "scene/keys/readers.h"

#include "core/deterministic_math.h"
#include "scene/fields/body_fields.h"
#include "scene/fields/many_bodies_fields.h"
#include "scene/keys/chain_curve.h"
#include "scene/keys/joints.h"
#include "scene/keys/read_fields.h"
#include "scene/keys/shapes.h"
#include "scene/toml/limits.h"

#include <fmt/format.h>

#include <optional>

namespace tumble {
namespace {

constexpr Choice<JointType> chain_joint_types[] = {
    {"ball", JointType::ball},
    {"hinge", JointType::hinge},
    {"universal", JointType::universal},
    {"fixed", JointType::fixed},
};

using ChainEnd = ChainRequest::End;

/// The keys of a chain, and its table for the positions of errors.
struct ChainTable : ChainRequest {
    const TomlTable& table;
};

ChainEnd read_end(const TomlValue& value, const BodyIndex& index) {
    if (value.text() == "free") {
        if (index.has("free")) value.fail("is an end without a joint, and a body has this name: give it another one");
        return {};
    }
    return {true, find_side(value, index)};
}

ChainTable read_chain(const TomlTable& table, const BodyIndex& index) {
    ChainTable chain{read_all_fields<ChainRequest, Material>(table), table};
    if (chain.loop) table.require("links").integer(3, limits::links);
    if (const auto value = table.find("ends")) {
        if (chain.loop) value->origin().fail("is for chains with ends (given one with loop = true)");
        const auto end = value->items(2, "names: of a body, \"world\" or \"free\"");
        for (std::size_t k = 0; k < 2; ++k) chain.ends[k] = read_end(end[k], index);
    }
    if (chain.loop)
        for (const char* key : {"sag", "length"})
            if (const auto value = table.find(key)) value->origin().fail("is for chains with ends (given a loop)");
    if (!chain.loop && chain.normal) table.require("normal").origin().fail("is for chains with loop = true");
    return chain;
}

ChainCurve hanging(const ChainTable& chain) {
    const Vec3 &from = chain.from, &to = chain.to;
    if (chain.sag && chain.length)
        chain.table.require("sag").origin().fail("and length exclude each other: give one of them");
    const TomlValue given = chain.table.require(chain.sag ? "sag" : "length");
    const double least = (to - from).norm();
    if (chain.length && *chain.length < least)
        given.fail(fmt::format("must be at least the distance of the ends, {:.6g} m", least));
    if (chain.length && *chain.length <= least * (1.0 + 1e-9)) return straight_chain(from, to, chain.links);
    if (chain.links < 2) given.fail("needs at least two links");
    const std::optional<ChainCurve> curve = chain.sag ? hanging_chain_of_sag(from, to, chain.links, *chain.sag)
                                                      : hanging_chain_of_length(from, to, chain.links, *chain.length);
    if (!curve)
        given.origin().fail(
            "has no hanging chain between these ends, which are too steep: give more links, ends that are "
            "less above each other, or a straight chain without sag and length");
    return *curve;
}

ChainCurve make_curve(const ChainTable& chain) {
    const Vec3 &from = chain.from, &to = chain.to;
    if (!limits::size.contains((to - from).norm())) chain.table.require("to").fail("must be another point than from");
    if (chain.loop) {
        std::optional<Vec3> normal = chain.normal;
        if (normal) {
            const Vec3 along = (to - from).normalized();
            if (std::fabs(normal->dot(along)) > limits::axis_tolerance)
                chain.table.require("normal").fail("must be square to the line from one point to the other");
            normal = (*normal - normal->dot(along) * along).normalized();
        }
        return closed_chain(from, to, chain.links, normal);
    }
    if (chain.sag || chain.length) return hanging(chain);
    return straight_chain(from, to, chain.links);
}

void check_lengths(const ChainTable& chain, const ChainCurve& curve) {
    for (std::size_t i = 0; i < chain.links; ++i) {
        const double length = (curve.corners[i + 1] - curve.corners[i]).norm();
        if (limits::size.contains(length)) continue;
        chain.table.require("links").fail(
            fmt::format("makes links of unusable length, {:.3g} m: give fewer links or a longer chain", length));
    }
}

Quat rotation_with(const Vec3& x, const Vec3& z) {
    Mat3 axes;
    axes.col(0) = x;
    axes.col(1) = z.cross(x);
    axes.col(2) = z;
    return Quat(axes).normalized();
}

void append_links(const ChainTable& chain, const ChainCurve& curve, const BodyDescription& model, BodyNames& names,
                  std::vector<BodyDescription>& bodies) {
    const SourcePosition origin = chain.table.require("name").origin();
    for (std::size_t i = 0; i < chain.links; ++i) {
        BodyDescription link = model;
        link.name = fmt::format("{}.{}", chain.name, i);
        names.take(link.name, origin);
        const Vec3 from = curve.corners[i], to = curve.corners[i + 1];
        link.position = 0.5 * (from + to);
        const SinCos half = sincos(0.5 * std::remainder(chain.twist * double(i), 360.0) * pi / 180.0);
        link.rotation =
            (rotation_with((to - from).normalized(), curve.normal) * Quat(half.cos, half.sin, 0.0, 0.0)).normalized();
        if (!chain.colors.empty()) link.appearance.color = chain.colors[i % chain.colors.size()];
        bodies.push_back(std::move(link));
    }
}

/// The joint of a chain: the name of its type, or a table with the keys of a joint.
class ChainJoint {
public:
    explicit ChainJoint(const ChainTable& chain) : table_(empty_, chain.table.origin(), "a joint of a chain") {
        const auto value = chain.table.find("joint");
        if (!value) return;
        if (!value->is_table()) {
            type_ = value->choice<JointType>(chain_joint_types);
            return;
        }
        table_ = value->table();
        table_.set_title("a joint of a chain");
        type_ = read_joint_type(table_);
        table_.require("type").choice<JointType>(chain_joint_types);
        for (const char* key :
             {"name", "bodies", "anchor", "anchors", "axes", "second_axis", "frame", "snap", "start_angle"})
            if (const auto given = table_.find(key)) given->origin().fail("is given by the chain: leave it out");
        if (const auto axis = table_.find("axis")) {
            if (type_ != JointType::hinge) axis->origin().fail("is given by the chain, but for a hinge");
            axis_ = axis->direction();
        }
    }

    JointDescription make(const ChainEnd& first, const ChainEnd& second, const ChainCurve& curve, std::size_t corner,
                          const Vec3& along, const std::vector<BodyDescription>& bodies) const {
        JointDescription joint;
        joint.type = type_;
        joint.first = first.body;
        joint.second = second.body;
        JointPlace place{curve.corners[corner], along, curve.normal.cross(along)};
        if (type_ == JointType::hinge || type_ == JointType::universal) {
            place.x = axis_ ? *axis_ : curve.normal;
            place.y = axis_ ? across(*axis_) : Vec3(place.x.cross(along));
        }
        return read_placed_joint(table_, joint, place, bodies);
    }

private:
    toml::table empty_;
    TomlTable table_;
    JointType type_ = JointType::ball;
    std::optional<Vec3> axis_;
};

void append_joints(const ChainTable& chain, const ChainCurve& curve, std::size_t first_link,
                   const std::vector<BodyDescription>& bodies, JointNames& names,
                   std::vector<JointDescription>& joints) {
    const ChainJoint model(chain);
    const SourcePosition origin = chain.table.require("name").origin();
    const std::size_t n = chain.links;
    check_number_of_joints(joints.size() + n + 1, chain.table.require("links").origin());
    const auto link = [&](std::size_t i) { return ChainEnd{true, first_link + i}; };
    const auto direction = [&](std::size_t i) { return Vec3((curve.corners[i + 1] - curve.corners[i]).normalized()); };
    const auto append = [&](const ChainEnd& first, const ChainEnd& second, std::size_t corner, const Vec3& along) {
        if (!first.joined || !second.joined) return;
        joints.push_back(model.make(first, second, curve, corner, along, bodies));
        joints.back().name = fmt::format("{}.{}", chain.name, corner);
        names.take(joints.back().name, origin);
    };
    const ChainEnd before = chain.loop ? link(n - 1) : chain.ends[0];
    append(before, link(0), 0, chain.loop ? Vec3((direction(n - 1) + direction(0)).normalized()) : direction(0));
    for (std::size_t i = 1; i < n; ++i) append(link(i - 1), link(i), i, (direction(i - 1) + direction(i)).normalized());
    if (!chain.loop) append(link(n - 1), chain.ends[1], n, direction(n - 1));
}

}  // namespace

void read_chains(const TomlTable& root, const BodySources& sources, std::vector<BodyDescription>& bodies,
                 std::vector<JointDescription>& joints) {
    const auto list = root.find("chain");
    if (!list) return;
    const BodyIndex index(bodies);
    BodyNames body_names(bodies);
    JointNames joint_names(joints);
    for (TomlTable& table : list->tables("; write [[chain]] for each")) {
        table.set_title("[[chain]]");
        const ChainTable chain = read_chain(table, index);
        check_number_of_bodies(std::int64_t(bodies.size() + chain.links), table.require("links").origin());
        ShapeRequest shape = read_shape(table.require("shape"), BodyType::dynamic, sources.folder, sources.meshes);
        const ChainCurve curve = make_curve(chain);
        check_lengths(chain, curve);
        const BodyDescription model = read_body_model(table, BodyType::dynamic, shape, sources);
        const std::size_t first_link = bodies.size();
        append_links(chain, curve, model, body_names, bodies);
        append_joints(chain, curve, first_link, bodies, joint_names, joints);
    }
}

}  // namespace tumble
