#include "api/spec_lines.h"

#include <variant>

namespace tumble::v0 {

std::string text_of(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            (quoted += '\\') += c;
        else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            quoted += c;
    }
    return quoted + "\"";
}

// 17 digits bring every double back to the bit; a point makes a whole number a double, which keeps the sign of zero.
std::string text_of(double value) {
    std::string text = fmt::format("{:.17g}", value);
    if (text.find_first_of(".en") == std::string::npos) text += ".0";
    return text;
}

std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(const Vec3& v) { return fmt::format("[{}, {}, {}]", text_of(v.x), text_of(v.y), text_of(v.z)); }
std::string text_of(Color c) { return fmt::format("\"#{:02x}{:02x}{:02x}\"", c.r, c.g, c.b); }
std::string text_of(const Rotation& rotation) {
    if (const auto* turn = std::get_if<AxisAngle>(&rotation))
        return fmt::format("{{ axis = {}, angle = {} }}", text_of(turn->axis), text_of(turn->degrees));
    const Quat& q = std::get<Quat>(rotation);
    return fmt::format("[{}, {}, {}, {}]", text_of(q.w), text_of(q.x), text_of(q.y), text_of(q.z));
}

std::string text_of(const std::vector<std::string>& all) {
    std::string text;
    for (const std::string& one : all) text += (text.empty() ? "" : ", ") + text_of(one);
    return "[" + text + "]";
}

void SpecLines::line(std::string_view content, std::string_view prefix, std::string_view field) {
    (text += content) += '\n';
    if (++lines_ != wanted_) return;
    element = prefix;
    if (!prefix.empty() && !field.empty()) element += '.';
    element += field;
}

void SpecLines::header(const std::string& content, std::string prefix) {
    prefix_ = std::move(prefix);
    line(content, prefix_, "");
}

void SpecLines::value(std::string_view key, std::string_view field, const std::string& content) {
    line(fmt::format("{} = {}", key, content), prefix_, field);
}

}  // namespace tumble::v0
