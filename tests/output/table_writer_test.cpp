// Every double is restored to the bit, in any locale; text is quoted if CSV requires it.
#include "output/table_writer.h"
#include "core/error.h"

#include "support/folder.h"

#include <gtest/gtest.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <sstream>

namespace tumble::table_writer_test {
namespace {

TEST(TableWriter, WritesRows) {
    const TestFolder folder;
    TableWriter table(folder / "t.csv", "frame,name,x");
    table.integer(0).text("plain").number(0.1).end_row();
    table.integer(-1).text("a, \"b\"\nc").number(2.0).end_row();
    EXPECT_FALSE(std::filesystem::exists(folder / "t.csv"));
    table.finish();
    EXPECT_EQ(read_text(folder / "t.csv"), "frame,name,x\n0,plain,0.10000000000000001\n-1,\"a, \"\"b\"\"\nc\",2\n");
}

TEST(TableWriter, EveryDoubleComesBack) {
    const TestFolder folder;
    std::mt19937_64 random(1);
    std::vector<double> values{0.0,
                               -0.0,
                               1.0 / 3.0,
                               1e300,
                               -1e-300,
                               std::numeric_limits<double>::denorm_min(),
                               std::numeric_limits<double>::max()};
    while (values.size() < 20000) {
        const double value = std::bit_cast<double>(random());
        if (std::isfinite(value)) values.push_back(value);
    }
    TableWriter table(folder / "t.csv", "x");
    for (const double value : values) {
        table.number(value);
        table.end_row();
    }
    table.finish();
    std::istringstream lines(read_text(folder / "t.csv"));
    std::string line;
    std::getline(lines, line);
    for (const double value : values) {
        std::getline(lines, line);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(line.c_str(), nullptr)), std::bit_cast<std::uint64_t>(value))
            << line;
    }
    EXPECT_FALSE(std::getline(lines, line));
}

TEST(TableWriter, TheLocaleChangesNothing) {
    // Not every machine has a locale with a decimal comma; without one, the test is weaker.
    const char* found = nullptr;
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"})
        if (found == nullptr) found = std::setlocale(LC_ALL, name);
    const TestFolder folder;
    TableWriter table(folder / "t.csv", "x");
    table.number(1234.5).end_row();
    table.finish();
    std::setlocale(LC_ALL, "C");
    EXPECT_EQ(read_text(folder / "t.csv"), "x\n1234.5\n");
}

TEST(TableWriter, AFullDiskIsAnError) {
    TableWriter table("/dev/full", "x");
    table.number(1.0).end_row();
    EXPECT_THROW(table.finish(), RunError);
}

TEST(TableWriter, UnfinishedLeavesNothing) {
    const TestFolder folder;
    {
        TableWriter table(folder / "t.csv", "x");
        for (int i = 0; i < 100000; ++i) table.integer(i).end_row();
    }
    EXPECT_EQ(folder.files(), 0u);
}

}  // namespace
}  // namespace tumble::table_writer_test
