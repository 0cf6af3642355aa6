// Tests that a raw file is read again only if it is still the file that was cataloged.
#include "stormcellar/catalog/read_cataloged.h"

#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "base/checksum.h"
#include "stormcellar/base/file_system.h"
#include "tests/catalog/catalog_fixture.h"

namespace stormcellar::catalog {
namespace {

class ReadCataloged : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(raw_.parent_path());
        std::ofstream(raw_) << "contents";
        reopen(drop_);
        ASSERT_TRUE(catalog_->register_file(facts()));
    }
    void reopen(const fs::path& drop) {
        CatalogOptions options;
        options.drop = drop;
        catalog_.emplace(*CatalogWriter::open(directory_ / "catalog", options));
    }
    [[nodiscard]] FileFacts facts() const {
        FileFacts facts = file(raw_, {volume("2022-03-17T00:00")});
        facts.size_bytes = 8;
        const std::string text = "contents";
        facts.content_hash = xxh3_64(std::as_bytes(std::span(text)));
        return facts;
    }
    Result<CatalogedBytes> read() {
        auto reader = CatalogReader::open(directory_ / "catalog");
        const auto entry = reader->find_file("KTLX", raw_);
        return read_cataloged(*reader, **entry);
    }
    void expect_refused(ErrorCode code, const std::string& reason) {
        const auto found = read();
        ASSERT_FALSE(found) << reason;
        EXPECT_EQ(found.error().code, code) << found.error().message;
        EXPECT_NE(found.error().message.find(reason), std::string::npos) << found.error().message;
        EXPECT_EQ(found.error().message.find(raw_.native()), 0U) << found.error().message;
    }
    void expect_a_linked_drop_directory_refused() {
        fs::rename(drop_, directory_ / "moved");
        fs::create_directory_symlink(directory_ / "moved", drop_);
        expect_refused(ErrorCode::not_found, "");
    }
    testing::TemporaryDirectory directory_;
    fs::path drop_ = directory_ / "drop";
    fs::path raw_ = drop_ / "KTLX/a";
    std::optional<CatalogWriter> catalog_;
};

TEST_F(ReadCataloged, TheFileThatWasCatalogedIsGiven) {
    const auto found = read();
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_TRUE(found->is_compared);
    EXPECT_EQ(found->bytes, *read_file(raw_));
}

TEST_F(ReadCataloged, AFileWithASecondNameIsGivenWhereItsHashProvesIt) {
    fs::create_hard_link(raw_, directory_ / "second-name");
    EXPECT_TRUE(read());
}

TEST_F(ReadCataloged, ALinkInItsPlaceIsNotFollowed) {
    fs::rename(raw_, directory_ / "same");
    fs::create_symlink(directory_ / "same", raw_);
    expect_refused(ErrorCode::not_a_file, "symbolic link");
    fs::remove(raw_);
    ASSERT_EQ(::mkfifo(raw_.c_str(), 0600), 0);
    expect_refused(ErrorCode::not_a_file, "FIFO");
    fs::remove(raw_);
    expect_refused(ErrorCode::not_found, "");
}

TEST_F(ReadCataloged, ALinkInPlaceOfADirectoryIsNotFollowed) {
    fs::rename(drop_ / "KTLX", directory_ / "elsewhere");
    fs::create_directory_symlink(directory_ / "elsewhere", drop_ / "KTLX");
    expect_refused(ErrorCode::not_found, "");
}

TEST_F(ReadCataloged, OtherContentsAreNotGiven) {
    std::ofstream(raw_) << "CONTENTS";
    expect_refused(ErrorCode::corrupt,
                   "is not the file that was cataloged: it has the same size but other contents");
    std::ofstream(raw_) << "more contents";
    expect_refused(ErrorCode::corrupt,
                   "is not the file that was cataloged: it has 13 bytes, not 8");
}

// The drop directory itself may be reached through a link, as when an operator has moved it.
TEST_F(ReadCataloged, OnlyWhatLiesBelowTheDropDirectoryMayBeNoLink) {
    fs::rename(drop_, directory_ / "larger-disk");
    fs::create_directory_symlink(directory_ / "larger-disk", drop_);
    EXPECT_TRUE(read());
}

TEST_F(ReadCataloged, WithoutADropDirectoryNoPartOfThePathMayBeALink) {
    fs::remove(directory_ / "catalog/drop-directory");
    EXPECT_TRUE(read());
    expect_a_linked_drop_directory_refused();
}

TEST_F(ReadCataloged, AFileOfAnotherDropDirectoryIsReadWithoutLinks) {
    reopen("/elsewhere");
    EXPECT_TRUE(read());
    expect_a_linked_drop_directory_refused();
}

TEST_F(ReadCataloged, AFileThatGrowsIsComparedAsFarAsItsRowGoes) {
    FileFacts seen = facts();
    seen.state = FileState::seen;
    seen.size_bytes = 4;
    ASSERT_TRUE(catalog_->register_file(seen));
    const auto found = read();
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_FALSE(found->is_compared);
    EXPECT_EQ(found->bytes.size(), 8U);
    fs::create_hard_link(raw_, directory_ / "second-name");
    expect_refused(ErrorCode::corrupt, "now has 2 names");
    fs::remove(directory_ / "second-name");
    std::ofstream(raw_) << "abc";
    expect_refused(ErrorCode::corrupt, "it has 3 bytes, not 4 or more");
    fs::rename(raw_, directory_ / "same");
    fs::create_symlink(directory_ / "same", raw_);
    expect_refused(ErrorCode::not_a_file, "symbolic link");
}

TEST_F(ReadCataloged, WhatWasNeverReadHasNothingToCompare) {
    FileFacts unread = facts();
    unread.state = FileState::rejected;
    unread.modified_ns = never_read_ns;
    unread.size_bytes = 0;
    ASSERT_TRUE(catalog_->register_file(unread));
    const auto found = read();
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_FALSE(found->is_compared);
}

TEST_F(ReadCataloged, TheDropDirectoryIsWrittenDownAndKept) {
    EXPECT_EQ(*catalog_->drop_directory(), drop_);
    const auto written = fs::last_write_time(directory_ / "catalog/drop-directory");
    reopen(drop_);
    reopen({});
    EXPECT_EQ(fs::last_write_time(directory_ / "catalog/drop-directory"), written);
    reopen("/other/new\nline");
    EXPECT_EQ(*catalog_->drop_directory(), "/other/new\nline");
    std::ofstream(directory_ / "catalog/drop-directory") << "relative";
    EXPECT_EQ(catalog_->drop_directory().error().code, ErrorCode::corrupt);
    EXPECT_EQ(read().error().code, ErrorCode::corrupt);
}

TEST_F(ReadCataloged, ARowsHashAndTimeComeWithIt) {
    const CatalogEntry entry = catalog_->list("KTLX", {})->at(0);
    EXPECT_EQ(entry.content_hash, facts().content_hash);
    EXPECT_EQ(entry.modified_ns, 42);
    EXPECT_EQ(*catalog_->find_file("KTLX", "/none"), std::nullopt);
    EXPECT_EQ((*catalog_->find_file("KTLX", raw_))->volume.start_time, std::nullopt);
}

}  // namespace
}  // namespace stormcellar::catalog
