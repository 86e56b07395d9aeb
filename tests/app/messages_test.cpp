#include "app/log/messages.h"
#include "core/error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <sstream>
#include <string>
#include <vector>

namespace tumble::messages_test {
namespace {

/// Messages into a pipe.
class Log {
public:
    Log() {
        EXPECT_EQ(::pipe(ends_), 0);
        messages.write_json_to(ends_[1]);
    }
    ~Log() {
        ::close(ends_[0]);
        ::close(ends_[1]);
    }
    std::vector<nlohmann::json> lines() const {
        std::string text(65536, '\0');
        const ssize_t n = ::read(ends_[0], text.data(), text.size());
        std::istringstream in(text.substr(0, std::size_t(std::max<ssize_t>(n, 0))));
        std::vector<nlohmann::json> all;
        for (std::string line; std::getline(in, line);) all.push_back(nlohmann::json::parse(line));
        return all;
    }
    Messages messages;

private:
    int ends_[2] = {-1, -1};
};

TEST(Messages, AsJsonAreAnObjectALine) {
    Log log;
    log.messages.say_text("wrote a \"quoted\" name\nand 2\n");
    log.messages.progress({.done = 30, .total = 120, .seconds = 2.0});
    const auto lines = log.lines();
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0]["event"], "message");
    EXPECT_EQ(lines[0]["text"], "wrote a \"quoted\" name");
    EXPECT_EQ(lines[1]["text"], "and 2");
    EXPECT_EQ(lines[2]["event"], "progress");
    EXPECT_EQ(lines[2]["done"], 30);
    EXPECT_EQ(lines[2]["per_second"], 15.0);
    EXPECT_EQ(lines[2]["seconds_left"], 6.0);
    for (const auto& line : lines) EXPECT_GE(line["t"].get<double>(), 0.0);
}

TEST(Messages, NameTheKindAndThePlaceOfAnError) {
    Log log;
    log.messages.fail(InputError({"a.toml", 3, 7}, "unknown key \"x\""));
    log.messages.fail(RunError("no space"));
    log.messages.fail(std::bad_alloc());
    log.messages.fail(std::runtime_error("odd"));
    const auto lines = log.lines();
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_EQ(lines[0]["kind"], "input");
    EXPECT_EQ(lines[0]["text"], "unknown key \"x\"");
    EXPECT_EQ(lines[0]["file"], "a.toml");
    EXPECT_EQ(lines[0]["line"], 3);
    EXPECT_EQ(lines[0]["column"], 7);
    EXPECT_EQ(lines[1]["kind"], "run");
    EXPECT_EQ(lines[1]["text"], "no space");
    EXPECT_FALSE(lines[1].contains("file"));
    EXPECT_EQ(lines[2]["text"], "out of memory");
    EXPECT_EQ(lines[3]["text"], "odd");
}

TEST(Messages, OfAnyBytesAreJson) {
    Log log;
    log.messages.say_text("\xff\x01\n");
    EXPECT_EQ(log.lines().size(), 1u);
}

TEST(Messages, NeedAnOpenDescriptor) {
    Messages messages;
    EXPECT_THROW(messages.write_json_to(987), InputError);
    const int file = ::open("/dev/null", O_RDONLY);
    EXPECT_THROW(messages.write_json_to(file), InputError);
    ::close(file);
    EXPECT_FALSE(messages.json());
    messages.event("nothing", nlohmann::ordered_json::object());
}

}  // namespace
}  // namespace tumble::messages_test
