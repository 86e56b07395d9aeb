#include "app/sweep/sample_record.h"

#include "app/sweep/toml_json.h"
#include "core/sha256.h"
#include "output/file_bytes.h"
#include "scene/toml/toml_text.h"
#include "tumble/version.h"

#include <fmt/format.h>

#include <utility>

namespace tumble {
namespace {

using RecordJson = nlohmann::ordered_json;

RecordJson json_of_file(const SampleFile& file) {
    RecordJson json;
    json["path"] = file.path;
    if (file.first) {
        json["first"] = *file.first;
        json["count"] = file.count;
    }
    json["bytes"] = file.bytes;
    json["crc32"] = fmt::format("{:08x}", file.checksum);
    return json;
}

SampleFile file_of_json(const RecordJson& json) {
    SampleFile file;
    file.path = json.at("path").get<std::string>();
    if (json.contains("first")) {
        file.first = json.at("first").get<std::int64_t>();
        file.count = json.at("count").get<std::int64_t>();
    }
    file.bytes = json.at("bytes").get<std::uint64_t>();
    file.checksum = std::uint32_t(std::stoul(json.at("crc32").get<std::string>(), nullptr, 16));
    return file;
}

/// The beginning of each line.
RecordJson head(const SweepPlan& plan, const SweepSample& sample, const char* status) {
    RecordJson json;
    json["index"] = sample.index;
    json["name"] = sample.name;
    json["status"] = status;
    RecordJson values = RecordJson::object();
    for (std::size_t i = 0; i < sample.values.size(); ++i) values[plan.axes[i].name] = json_of(sample.values[i]);
    json["values"] = std::move(values);
    if (sample.pair) {
        json["pair"] = sample.pair->pair;
        json["side"] = std::string(1, sample.pair->side);
        json["differs"] = sample.pair->differs;
    }
    return json;
}

/// Names and other foreign text may not be UTF-8.
std::string text_of(const RecordJson& json) { return json.dump(-1, ' ', false, RecordJson::error_handler_t::replace); }

}  // namespace

std::string record_text(const SweepPlan& plan, const SampleRecord& record) {
    RecordJson json = head(plan, record.sample, "done");
    json["scene_hash"] = record.scene_hash;
    json["identity"] = record.identity;
    const SampleFigures& f = record.figures;
    json["frames"] = f.frames;
    json["drawn"] = f.drawn;
    json["bodies"] = f.bodies;
    json["width"] = f.width;
    json["height"] = f.height;
    json["fps"] = f.fps;
    json["duration"] = f.duration;
    RecordJson files = RecordJson::array();
    for (const SampleFile& file : record.files) files.push_back(json_of_file(file));
    json["files"] = std::move(files);
    return text_of(json);
}

std::string failure_text(const SweepPlan& plan, const SweepSample& sample, const std::string& reason) {
    RecordJson json = head(plan, sample, "failed");
    json["reason"] = reason;
    return text_of(json);
}

std::optional<KnownRecord> read_sample_record(const std::filesystem::path& folder) {
    std::optional<std::string> text = bytes_of_file(folder / record_name);
    if (!text) return std::nullopt;
    KnownRecord known;
    known.text = std::move(*text);
    if (!known.text.empty() && known.text.back() == '\n') known.text.pop_back();
    try {
        const RecordJson json = RecordJson::parse(known.text);
        known.identity = json.at("identity").get<std::string>();
        for (const RecordJson& one : json.at("files")) known.files.push_back(file_of_json(one));
    } catch (const std::exception&) {  // of the parser or std::stoul: the record of another program, or damaged
        return std::nullopt;
    }
    return known;
}

std::string identity_of(const SweepPlan& plan, const SweepSample& sample, const std::string& scene_hash) {
    const SampleOutputs& o = plan.outputs;
    const SampleDrawing& d = plan.drawing;
    std::string text = fmt::format("{}\n{}\n{}\n", v0::version(), scene_hash, text_of(head(plan, sample, "done")));
    text += fmt::format("{} {} {} {}{}{}{}{} {} {}\n", o.frames, toml_string(o.clip), names_of(o.aovs), o.trajectory,
                        o.energy, o.impacts, o.contacts, o.loads, o.arrays, int(o.scene));
    text += fmt::format("{} {} {} {} {} {} {}\n", d.start, d.speed, d.shutter, d.blur_samples, d.transparent,
                        int(d.quality), int(d.backend));
    return sha256(text);
}

}  // namespace tumble
