// The main function of the test programs: PROGRAM [FILE] [option of GoogleTest]...
// With FILE, the name of a source file, only the tests of that file run: ctest gives each file a process of its own,
// whose signals, limits and threads disturb no other file.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>

namespace {

/// A filter of GoogleTest for the tests of one source file; empty if it has none.
std::string filter_of_file(const std::string& file_name) {
    std::string filter;
    const testing::UnitTest& all = *testing::UnitTest::GetInstance();
    for (int i = 0; i < all.total_test_suite_count(); ++i) {
        const testing::TestSuite& suite = *all.GetTestSuite(i);
        for (int j = 0; j < suite.total_test_count(); ++j) {
            const testing::TestInfo& test = *suite.GetTestInfo(j);
            if (std::filesystem::path(test.file()).filename() == file_name)
                filter += std::string(filter.empty() ? "" : ":") + suite.name() + "." + test.name();
        }
    }
    return filter;
}

}  // namespace

int main(int argument_count, char** arguments) {
    testing::InitGoogleTest(&argument_count, arguments);
    if (argument_count > 1) {
        const std::string of_file = filter_of_file(arguments[1]);
        if (of_file.empty()) {
            std::fprintf(stderr, "%s: no tests of a file '%s'\n", arguments[0], arguments[1]);
            return 2;
        }
        // Another filter is that of one test: of a user, or of the child process of a death test.
        if (GTEST_FLAG_GET(filter) == "*") GTEST_FLAG_SET(filter, of_file);
    }
    return RUN_ALL_TESTS();
}
