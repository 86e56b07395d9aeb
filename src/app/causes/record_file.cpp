#include "app/causes/motion_record.h"

#include "core/error.h"
#include "core/html_text.h"
#include "core/input_file.h"
#include "core/safe_text.h"
#include "output/temporary_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tumble {
namespace {

// Numbers as bytes, least significant first, for the base64 parts of a motion record.

class RecordWriter {
public:
    template <class Number>
    void add(Number number) {
        if constexpr (std::is_same_v<Number, float>)
            add(std::bit_cast<std::uint32_t>(number));
        else
            for (std::size_t i = 0; i < sizeof(Number); ++i)
                bytes_.push_back(std::byte(std::make_unsigned_t<Number>(number) >> (8 * i) & 0xff));
    }
    const std::vector<std::byte>& bytes() const { return bytes_; }

private:
    std::vector<std::byte> bytes_;
};

/// Throws std::out_of_range beyond the end.
class RecordReader {
public:
    explicit RecordReader(std::string_view bytes) : bytes_(bytes) {}

    bool at_end() const { return bytes_.empty(); }

    template <class Number>
    Number next() {
        if constexpr (std::is_same_v<Number, float>) {
            return std::bit_cast<float>(next<std::uint32_t>());
        } else {
            if (bytes_.size() < sizeof(Number)) throw std::out_of_range("numbers are missing");
            std::make_unsigned_t<Number> number = 0;
            for (std::size_t i = 0; i < sizeof(Number); ++i)
                number = std::make_unsigned_t<Number>(
                    number | std::make_unsigned_t<Number>(static_cast<unsigned char>(bytes_[i])) << (8 * i));
            bytes_.remove_prefix(sizeof(Number));
            return Number(number);
        }
    }

private:
    std::string_view bytes_;
};

using Json = nlohmann::ordered_json;

constexpr int record_format = 1;
constexpr double rotation_unit = 32767.0;       // of a component of a rotation
constexpr std::int64_t record_bytes = 1 << 30;  // of a file: a clip of hundreds of bodies and thousands of frames

// -- Writing

std::string text_of(const RecordWriter& writer) { return base64(writer.bytes()); }

void add_pose(const RecordedPose& pose, RecordWriter& to) {
    for (const double x : {pose.origin.x(), pose.origin.y(), pose.origin.z()}) to.add(float(x));
    const Quat& q = pose.rotation;
    for (const double x : {q.w(), q.x(), q.y(), q.z()}) to.add(std::int16_t(std::lround(rotation_unit * x)));
}

Json record_json(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

Json record_json(const ValueMap& values) {
    Json json = Json::object();
    for (const auto& [key, value] : values) json[key] = value;
    return json;
}

Json record_json(const BodyKind& kind) {
    Json json{{"look", record_json(kind.look)}, {"matter", record_json(kind.matter)}, {"round", kind.round}};
    if (!kind.bounds.empty())
        json["bounds"] = Json::array({record_json(kind.bounds.min), record_json(kind.bounds.max)});
    return json;
}

Json record_json(const RecordedView& view) {
    return Json::array({record_json(view.eye), record_json(view.target), record_json(view.up), view.vertical_fov});
}

bool same_view(const RecordedView& a, const RecordedView& b) {
    return a.eye == b.eye && a.target == b.target && a.up == b.up && a.vertical_fov == b.vertical_fov;
}

Json views_json(const std::vector<RecordedView>& views) {
    Json json = Json::array();
    for (const RecordedView& view : views) {
        json.push_back(record_json(view));
        if (std::ranges::all_of(views, [&](const RecordedView& v) { return same_view(v, views.front()); })) break;
    }
    return json;
}

Json record_json(const MotionTrace& trace) {
    RecordWriter frames, blocks;
    for (const std::uint32_t sum : trace.frames) frames.add(sum);
    for (const std::uint16_t sum : trace.blocks) blocks.add(sum);
    return {{"frames", text_of(frames)}, {"every", trace.every}, {"blocks", text_of(blocks)}};
}

Json record_json(const PanelRecord& panel) {
    const Rectangle& r = panel.place;
    Json json{{"place", Json::array({r.x, r.y, r.width, r.height})}, {"values", record_json(panel.values)}};
    json["kinds"] = Json::array();
    for (const BodyKind& kind : panel.kinds) json["kinds"].push_back(record_json(kind));
    json["bodies"] = Json::array();
    for (const RecordedBody& body : panel.bodies)
        json["bodies"].push_back(Json::array({safe_text(body.name, value_text_bytes), body.kind, body.moves}));
    RecordWriter start, poses, contacts;
    for (const RecordedPose& pose : panel.start) add_pose(pose, start);
    for (const auto& frame : panel.poses)
        for (const RecordedPose& pose : frame) add_pose(pose, poses);
    for (const RecordedContact& c : panel.contacts) {
        contacts.add(c.time);
        contacts.add(c.a);
        contacts.add(c.b);
        contacts.add(c.impulse);
    }
    json["start"] = text_of(start);
    json["times"] = panel.times;
    json["views"] = views_json(panel.views);
    json["poses"] = text_of(poses);
    json["trace"] = record_json(panel.trace);
    json["contacts"] = text_of(contacts);
    json["all_contacts"] = panel.all_contacts;
    return json;
}

// -- Reading

Vec3 vector_of(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

ValueMap values_of(const Json& json) {
    ValueMap values;
    for (const auto& [key, value] : json.items()) values[key] = value.get<std::string>();
    return values;
}

std::string bytes_of(const Json& json) {
    std::optional<std::string> bytes = decode_base64(json.get_ref<const std::string&>());
    if (!bytes) throw std::out_of_range("a part is not base64");
    return std::move(*bytes);
}

RecordedPose next_pose(RecordReader& from) {
    RecordedPose pose;
    for (int i = 0; i < 3; ++i) pose.origin[i] = from.next<float>();
    double q[4];
    for (double& x : q) x = from.next<std::int16_t>() / rotation_unit;
    pose.rotation = Quat(q[0], q[1], q[2], q[3]);
    pose.rotation.normalize();
    return pose;
}

BodyKind kind_of(const Json& json) {
    BodyKind kind;
    kind.look = values_of(json.at("look"));
    kind.matter = values_of(json.at("matter"));
    kind.round = json.at("round").get<bool>();
    if (json.contains("bounds")) {
        kind.bounds.min = vector_of(json["bounds"].at(0));
        kind.bounds.max = vector_of(json["bounds"].at(1));
    }
    return kind;
}

RecordedView view_of(const Json& json) {
    return {vector_of(json.at(0)), vector_of(json.at(1)), vector_of(json.at(2)), json.at(3).get<double>()};
}

MotionTrace trace_of(const Json& json) {
    MotionTrace trace;
    const std::string frames = bytes_of(json.at("frames")), blocks = bytes_of(json.at("blocks"));
    for (RecordReader from(frames); !from.at_end();) trace.frames.push_back(from.next<std::uint32_t>());
    for (RecordReader from(blocks); !from.at_end();) trace.blocks.push_back(from.next<std::uint16_t>());
    trace.every = json.at("every").get<int>();
    if (trace.every < 1) throw std::out_of_range("the trace has blocks of no frames");
    return trace;
}

void read_poses(const Json& json, std::size_t frames, PanelRecord& panel) {
    std::size_t moving = 0;
    for (const RecordedBody& body : panel.bodies) moving += body.moves ? 1 : 0;
    const std::string start = bytes_of(json.at("start")), poses = bytes_of(json.at("poses"));
    RecordReader from_start(start), from(poses);
    for (std::size_t i = 0; i < panel.bodies.size(); ++i) panel.start.push_back(next_pose(from_start));
    for (std::size_t f = 0; f < frames; ++f) {
        auto& of_frame = panel.poses.emplace_back();
        for (std::size_t i = 0; i < moving; ++i) of_frame.push_back(next_pose(from));
    }
    panel.times = json.at("times").get<std::vector<double>>();
    if (panel.times.size() != frames) throw std::out_of_range("times are missing");
    const Json& views = json.at("views");
    for (std::size_t f = 0; f < frames; ++f) panel.views.push_back(view_of(views.at(views.size() == 1 ? 0 : f)));
    if (moving > 0 && panel.trace.blocks.size() % moving != 0) throw std::out_of_range("the trace is cut");
}

PanelRecord panel_of(const Json& json, std::size_t frames) {
    PanelRecord panel;
    const Json& place = json.at("place");
    panel.place = {place.at(0).get<int>(), place.at(1).get<int>(), place.at(2).get<int>(), place.at(3).get<int>()};
    panel.values = values_of(json.at("values"));
    for (const Json& kind : json.at("kinds")) panel.kinds.push_back(kind_of(kind));
    for (const Json& body : json.at("bodies")) {
        panel.bodies.push_back({body.at(0).get<std::string>(), body.at(1).get<std::size_t>(), body.at(2).get<bool>()});
        if (panel.bodies.back().kind >= panel.kinds.size()) throw std::out_of_range("a body is of no kind");
    }
    panel.trace = trace_of(json.at("trace"));
    read_poses(json, frames, panel);
    const std::string contacts = bytes_of(json.at("contacts"));
    for (RecordReader from(contacts); !from.at_end();) {
        RecordedContact c;
        c.time = from.next<float>();
        c.a = from.next<std::uint32_t>();
        c.b = from.next<std::uint32_t>();
        c.impulse = from.next<float>();
        if (std::max(c.a, c.b) >= panel.bodies.size()) throw std::out_of_range("a contact is of no body");
        panel.contacts.push_back(c);
    }
    panel.all_contacts = json.at("all_contacts").get<bool>();
    return panel;
}

MotionRecord record_of(const Json& json) {
    if (json.at("motion_record").get<int>() != record_format) throw std::out_of_range("it is of another version");
    MotionRecord record;
    record.values = values_of(json.at("values"));
    record.frames = json.at("frames").get<std::vector<std::int64_t>>();
    record.whole_run = json.at("whole_run").get<bool>();
    for (const Json& panel : json.at("panels")) record.panels.push_back(panel_of(panel, record.frames.size()));
    return record;
}

}  // namespace

std::string record_text(const MotionRecord& record) {
    Json json{{"motion_record", record_format}, {"values", record_json(record.values)}, {"frames", record.frames}};
    json["whole_run"] = record.whole_run;
    json["panels"] = Json::array();
    for (const PanelRecord& panel : record.panels) json["panels"].push_back(record_json(panel));
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_motion_record(const std::filesystem::path& file, const MotionRecord& record) {
    write_file(file, record_text(record));
}

MotionRecord parse_record(const std::string& text, const std::filesystem::path& file) {
    const auto fail = [&](const std::string& problem) {
        return InputError({file.string(), 0, 0}, fmt::format("is no motion record of this version: {}", problem));
    };
    try {
        return record_of(Json::parse(text));
    } catch (const nlohmann::json::exception& error) {
        throw fail(safe_text(error.what(), 200));
    } catch (const std::out_of_range& error) {
        throw fail(error.what());
    }
}

MotionRecord read_motion_record(const std::filesystem::path& file) {
    return parse_record(read_input_file(file, "the motion record", record_bytes), file);
}

}  // namespace tumble
