#include "cli/shared/source_names.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

bool no_domain(const std::string& /*word*/) {
    return false;
}

bool is_ktlx(const std::string& word) {
    return word == "KTLX";
}

TEST(SourceNames, ASlashMakesAPath) {
    const auto names = tell_apart({"./KTLX", "raw/KTLX"}, "", is_ktlx);
    ASSERT_TRUE(names) << names.error().message;
    EXPECT_THAT(names->files, ElementsAre("./KTLX", "raw/KTLX"));
    EXPECT_EQ(names->domain, "");
    EXPECT_THAT(tell_apart({"-"}, "", is_ktlx)->files, ElementsAre("-"));
}

TEST(SourceNames, AnyOtherWordIsADomain) {
    const auto names = tell_apart({"KTLX"}, "", is_ktlx);
    ASSERT_TRUE(names);
    EXPECT_THAT(names->files, IsEmpty());
    EXPECT_EQ(names->domain, "KTLX");
    EXPECT_EQ(tell_apart({}, "KTLX", is_ktlx)->domain, "KTLX");
    EXPECT_EQ(tell_apart({}, "", is_ktlx)->domain, "");
}

TEST(SourceNames, AMemberOfAnArchiveIsAFile) {
    const testing::TemporaryDirectory directory;
    const testing::WorkingDirectory inside(directory.path());
    std::ofstream("day.tar") << "an archive";
    const auto names = tell_apart({"day.tar!KTLX.gz"}, "", no_domain);
    ASSERT_TRUE(names) << names.error().message;
    EXPECT_THAT(names->files, ElementsAre("day.tar!KTLX.gz"));
}

TEST(SourceNames, WhatCouldBeBothIsRefused) {
    const testing::TemporaryDirectory directory;
    const testing::WorkingDirectory inside(directory.path());
    std::ofstream("KTLX") << "a file";
    const auto both = tell_apart({"KTLX"}, "", is_ktlx);
    const auto file = tell_apart({"KTLX"}, "", no_domain);
    const auto domain = tell_apart({}, "KTLX", is_ktlx);
    ASSERT_FALSE(both);
    EXPECT_EQ(both.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(both.error().message, HasSubstr("./KTLX"));
    EXPECT_THAT(both.error().message, HasSubstr("--domain KTLX"));
    ASSERT_TRUE(file);
    EXPECT_THAT(file->files, ElementsAre("KTLX"));
    ASSERT_TRUE(domain);
    EXPECT_EQ(domain->domain, "KTLX");
}

TEST(SourceNames, AMistypedFileIsNoDomain) {
    for (const char* word : {"KTLX19990503_235621.gz", "volume.ar2v", "KTLX20130520_200356_V06"}) {
        const auto names = tell_apart({word}, "", no_domain);
        ASSERT_FALSE(names) << word;
        EXPECT_EQ(names.error().code, ErrorCode::not_found);
        EXPECT_THAT(names.error().message, HasSubstr("no such file"));
    }
    EXPECT_FALSE(tell_apart({"KTLX", "KFDR"}, "", is_ktlx));
    EXPECT_FALSE(tell_apart({"KTLX"}, "KFDR", is_ktlx));
    EXPECT_FALSE(tell_apart({"./a"}, "KFDR", is_ktlx));
}

}  // namespace
}  // namespace stormcellar::cli
