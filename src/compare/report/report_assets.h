// The style sheet and the script of a report, compiled in from report.css and report.js.
#pragma once

#include <string_view>

namespace tumble {

struct ReportAsset {
    std::string_view text;
    std::string_view sha256;  // of the text, hexadecimal: its content security policy allows this text only
};

ReportAsset report_style();
ReportAsset report_script();

}  // namespace tumble
