#include "level2/containers/archive_header.h"

#include <gtest/gtest.h>

#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

TEST(ArchiveHeader, IsReadFieldByField) {
    const auto header = read_archive_header(wire::archive_header("AR2V0006.116", "KLOT"));
    ASSERT_TRUE(header);
    EXPECT_EQ(header->filename, "AR2V0006.116");
    EXPECT_EQ(header->date, wire::day);
    EXPECT_EQ(header->ms, 3'600'000);
    EXPECT_EQ(header->icao, "KLOT");
}

TEST(ArchiveHeader, OfTheFirstKindNamesNoSite) {
    const auto header = read_archive_header(wire::archive_header("ARCHIVE2.008", "    "));
    ASSERT_TRUE(header);
    EXPECT_EQ(header->icao, "");
}

TEST(ArchiveHeader, IsNotFoundInOtherOrFewerBytes) {
    EXPECT_FALSE(read_archive_header(wire::archive_header("AR2X0006.116")));
    EXPECT_FALSE(read_archive_header(wire::archive_header("AR2V0006x116")));
    wire::Bytes cut = wire::archive_header();
    cut.pop_back();
    EXPECT_FALSE(read_archive_header(cut));
    EXPECT_FALSE(read_archive_header({}));
}

TEST(ArchiveHeader, UnprintableCharactersDoNotGetOut) {
    const auto header = read_archive_header(wire::archive_header("AR2V0006.\x1b\n\xff"));
    ASSERT_TRUE(header);
    EXPECT_EQ(header->filename, "AR2V0006.???");
}

}  // namespace
}  // namespace stormcellar::level2
