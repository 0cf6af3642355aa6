#include "pipeline/ingest/file_kind.h"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "tests/level2/wire.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

constexpr const char* chunk_name = "KTLX/494/20220317-000842-003-I";

class FileKindTest : public ::testing::Test {
  protected:
    FileKindTest() {
        catalog_.emplace(*catalog::CatalogWriter::open(directory_ / "catalog"));
        store_.emplace(*cache::StoreWriter::open(real_file_system(), directory_ / "cache", true));
        IngestOptions options;
        options.beneath = directory_.path();
        options.living.scratch = directory_.path();
        options.most_file_bytes = 1000;
        context_.emplace(*catalog_, &*store_, options);
    }
    [[nodiscard]] fs::path at(const std::string& name) const { return directory_ / "drop" / name; }
    // Writes only the header of a volume, so the file must be growing.
    fs::path put(const std::string& name, std::size_t more_bytes = 0) {
        fs::create_directories(at(name).parent_path());
        const level2::wire::Bytes header = level2::wire::archive_header();
        testing::write_bytes(at(name), header);
        testing::append_to(at(name), std::vector(more_bytes, std::byte{'x'}));
        return at(name);
    }
    [[nodiscard]] FileKind kind(const OfferedFile& file) {
        auto found = kind_of(*context_, file);
        EXPECT_TRUE(found) << found.error().message;
        return found ? std::move(*found) : FileKind{};
    }
    template <class Kind>
    [[nodiscard]] bool is(const OfferedFile& file) {
        return std::holds_alternative<Kind>(kind(file));
    }

    testing::TemporaryDirectory directory_;
    std::optional<catalog::CatalogWriter> catalog_;
    std::optional<cache::StoreWriter> store_;
    std::optional<IngestContext> context_;
};

TEST_F(FileKindTest, WhatIsNotThereIsGoneWhateverItsName) {
    EXPECT_FALSE(std::get<Gone>(kind({at("KTLX_a")})).chunk);
    const auto chunk = std::get<Gone>(kind({at(chunk_name)})).chunk;
    ASSERT_TRUE(chunk);
    EXPECT_EQ(chunk->name.number, 3);
}

TEST_F(FileKindTest, AChunkIsToldByItsName) {
    const OfferedFile file{put(chunk_name)};
    EXPECT_EQ(std::get<Chunk>(kind(file)).name.path, file.path);
    const FileStamp stamp = stamp_of(file.path).value();
    EXPECT_TRUE(std::holds_alternative<Growing>(kind_by_itself(*context_, file, stamp)))
        << "a file that is not a chunk is classified without its name";
    fs::remove(file.path);
    fs::create_directory(file.path);
    EXPECT_TRUE(is<Whole>(file)) << "a directory counts as Whole, whose handler rejects it";
}

TEST_F(FileKindTest, AFileWithoutItsEndGrowsUntilItIsToBeTakenAsItIs) {
    const auto path = put("KTLX_a");
    const auto growing = std::get<Growing>(kind({path}));
    EXPECT_FALSE(growing.followed);
    EXPECT_EQ(growing.start.station, "KTLX");
    EXPECT_TRUE(is<Whole>({.path = path, .finish = Finish::when_quiet}));
    const auto followed = context_->living->begin(path, "KTLX", "KTLX");
    ASSERT_TRUE(followed);
    EXPECT_EQ(std::get<Growing>(kind({path})).followed, followed);
    EXPECT_EQ(std::get<Growing>(kind({.path = path, .finish = Finish::when_quiet})).followed,
              followed);
    EXPECT_TRUE(is<Whole>({.path = path, .finish = Finish::as_it_is, .is_again = true}));
}

TEST_F(FileKindTest, EverythingElseIsWhole) {
    EXPECT_TRUE(is<Whole>({put("KTLX_other", 100)})) << "no LDM records follow the header";
    EXPECT_TRUE(is<Whole>({put("KTLX_large", 1000)})) << "the file is too large to be followed";
    EXPECT_TRUE(is<Whole>({put(chunk_name, 1000)}));
}

TEST_F(FileKindTest, WhatTheCatalogKnowsWithThisStampIsSettled) {
    const auto path = put("KTLX_a");
    const FileStamp stamp = stamp_of(path).value();
    catalog::FileFacts facts = facts_unread(path, stamp, "KTLX");
    facts.state = catalog::FileState::complete;
    ASSERT_TRUE(context_->record(facts));
    EXPECT_TRUE(is<Settled>({path}));
    put("KTLX_a", 10);
    EXPECT_FALSE(is<Settled>({path}));
}

TEST_F(FileKindTest, AskingChangesNothing) {
    const auto growing = put("KTLX_a");
    const auto chunk = put(chunk_name);
    for (int i = 0; i < 2; ++i) {
        EXPECT_FALSE(std::get<Growing>(kind({growing})).followed);
        EXPECT_TRUE(is<Chunk>({chunk}));
        EXPECT_TRUE(is<Gone>({at("gone")}));
    }
    EXPECT_EQ(context_->living->count(), 0U);
    EXPECT_EQ(context_->chunks.count(), 0U);
    for (const auto& path : {growing, chunk, at("gone")})
        EXPECT_FALSE(catalog_->is_known(path).value()) << path;
}

}  // namespace
}  // namespace stormcellar::pipeline
