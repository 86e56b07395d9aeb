#include "scene/description/label.h"

#include <fmt/format.h>

#include <array>

namespace tumble {
namespace {

struct NamedValue {
    std::string_view name;
    LabelValue value;
    LabelField standard() const {
        if (value == LabelValue::mass) return {value, 4, 'g'};
        return {value, 2, 'f'};
    }
};
constexpr std::array<NamedValue, 12> named{{{"name", LabelValue::name},
                                            {"mass", LabelValue::mass},
                                            {"speed", LabelValue::speed},
                                            {"velocity", LabelValue::velocity},
                                            {"position", LabelValue::position},
                                            {"x", LabelValue::x},
                                            {"y", LabelValue::y},
                                            {"z", LabelValue::z},
                                            {"omega", LabelValue::omega},
                                            {"momentum", LabelValue::momentum},
                                            {"kinetic", LabelValue::kinetic},
                                            {"time", LabelValue::time}}};

constexpr int most_digits = 15;

/// ".2f", ".2" or "": false for other text.
bool read_form(std::string_view form, LabelField& field) {
    if (form.empty()) return true;
    if (form.front() != '.') return false;
    form.remove_prefix(1);
    std::size_t digits = 0;
    field.digits = 0;
    while (digits < form.size() && form[digits] >= '0' && form[digits] <= '9' && digits < 2)
        field.digits = 10 * field.digits + (form[digits++] - '0');
    form.remove_prefix(digits);
    if (digits == 0 || field.digits > most_digits || form.size() > 1) return false;
    field.form = 'f';
    if (form.empty()) return true;
    field.form = form.front();
    return field.form == 'f' || field.form == 'g' || field.form == 'e';
}

std::string known_names() {
    std::string names;
    for (const NamedValue& one : named) names += fmt::format("{}{}", names.empty() ? "" : ", ", one.name);
    return names;
}

}  // namespace

LabelText parse_label(std::string_view text) {
    LabelText label;
    std::string plain;
    const auto fail = [&](std::string fault) { return LabelText{{}, std::move(fault)}; };
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c != '{' && c != '}') {
            plain += c;
            continue;
        }
        if (i + 1 < text.size() && text[i + 1] == c) {
            plain += c;
            ++i;
            continue;
        }
        if (c == '}') return fail("has a \"}\" without a \"{\" before it; write }} for the sign itself");
        const std::size_t end = text.find('}', i);
        if (end == std::string_view::npos)
            return fail("has a \"{\" without a \"}\" behind it; write {{ for the sign itself");
        const std::string_view inside = text.substr(i + 1, end - i - 1);
        const std::size_t colon = std::min(inside.find(':'), inside.size());
        const std::string_view name = inside.substr(0, colon);
        const NamedValue* found = nullptr;
        for (const NamedValue& one : named)
            if (one.name == name) found = &one;
        if (found == nullptr) return fail(fmt::format("has an unknown placeholder (known: {})", known_names()));
        LabelField field = found->standard();
        const bool formed = colon < inside.size();
        if (formed && (found->value == LabelValue::name || !read_form(inside.substr(colon + 1), field)))
            return fail(fmt::format("has a placeholder {{{}:...}} whose form is not {}", name,
                                    found->value == LabelValue::name
                                        ? "empty: a name has no digits"
                                        : "like \":.2f\" (digits from 0 to 15; f, g or e)"));
        if (!plain.empty()) label.pieces.emplace_back(std::move(plain));
        plain.clear();
        label.pieces.emplace_back(field);
        i = end;
    }
    if (!plain.empty()) label.pieces.emplace_back(std::move(plain));
    return label;
}

}  // namespace tumble
