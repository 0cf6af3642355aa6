// Tests the bucket of chunks with the requests of clients of the public real-time bucket.
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "stormcellar/base/file_system.h"
#include "tests/web/served_volumes.h"
#include "web/doors/s3/chunks.h"
#include "web/doors/s3/s3.h"

namespace stormcellar::web {
namespace {

using Texts = std::vector<std::string>;

constexpr const char* chunk_bucket = "/s3/unidata-nexrad-level2-chunks";
const std::string klot_volume = "KLOT/901/20260328-201457-";

class S3Chunks : public DoorTest<S3Door> {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        served_ = std::make_unique<ServedVolumes>();
        door_ = std::make_unique<S3Door>(served_->files(), "unidata-nexrad-level2");
    }
    Texts texts(const std::string& query, const char* path) {
        const Answer answer = get(chunk_bucket + query);
        EXPECT_EQ(answer.status, 200U) << query;
        pugi::xml_document document;
        const std::string text = body_of(answer);
        EXPECT_TRUE(document.load_string(text.c_str())) << text;
        Texts found;
        for (const auto& node :
             document.select_nodes(("/ListBucketResult/" + std::string(path)).c_str()))
            found.emplace_back(node.node().child_value());
        return found;
    }
    Texts keys(const std::string& query) { return texts(query, "Contents/Key"); }
    Texts prefixes(const std::string& query) { return texts(query, "CommonPrefixes/Prefix"); }
    std::unique_ptr<ServedVolumes> served_;
};

std::string klot_key(int number, char kind) {
    return fmt::format("{}{:03}-{}", klot_volume, number, kind);
}

std::string bytes_of_chunk(int number, char kind) {
    const auto path = *testing::data_directory() / "chunks/OPENRADAR_KLOT" /
                      fmt::format("20260328-201457-{:03}-{}", number, kind);
    const auto bytes = read_file(path);
    return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
}

TEST_F(S3Chunks, AVolumeThatCameInChunksHasTheBytesOfItsChunks) {
    served_->take_chunks(55);
    const Texts all = keys("?list-type=2&prefix=KLOT/901/");
    const Texts sizes = texts("?list-type=2&prefix=KLOT/901/", "Contents/Size");
    ASSERT_EQ(all.size(), 55U);
    for (int number = 1; number <= 55; ++number) {
        const char kind = number == 1 ? 'S' : number == 55 ? 'E' : 'I';
        const auto at = static_cast<std::size_t>(number - 1);
        EXPECT_EQ(all[at], klot_key(number, kind));
        const Answer answer = get(fmt::format("{}/{}", chunk_bucket, all[at]));
        ASSERT_EQ(answer.status, 200U) << all[at];
        EXPECT_EQ(body_of(answer), bytes_of_chunk(number, kind)) << all[at];
        EXPECT_EQ(sizes[at], std::to_string(body_of(answer).size()));
    }
    const Texts tags = texts("?list-type=2&prefix=KLOT/901/", "Contents/ETag");
    const Answer answer = get(fmt::format("{}/{}", chunk_bucket, all[6]), {{"Range", "bytes=4-6"}});
    EXPECT_EQ(answer.status, 206U);
    EXPECT_EQ(body_of(answer), "BZh");
    EXPECT_EQ(header_of(answer, "ETag"), tags[6]);
    EXPECT_NE(tags[6], tags[7]);
}

TEST_F(S3Chunks, AGrowingVolumeHasNoEndYet) {
    served_->take_chunks(20);
    const Texts all = keys("?list-type=2&prefix=KLOT/");
    ASSERT_EQ(all.size(), 20U);
    EXPECT_EQ(all.back(), klot_key(20, 'I'));
    const std::string tag = texts("?list-type=2&prefix=" + all[3], "Contents/ETag").at(0);
    // A client asks for the keys after the last one that it has.
    EXPECT_EQ(keys("?list-type=2&prefix=KLOT/901/&start-after=" + all.back()), Texts{});
    served_->take_chunks(22);
    EXPECT_EQ(keys("?list-type=2&prefix=KLOT/901/&start-after=" + all.back()),
              (Texts{klot_key(21, 'I'), klot_key(22, 'I')}));
    EXPECT_EQ(texts("?list-type=2&prefix=" + all[3], "Contents/ETag").at(0), tag)
        << "the bytes of the chunk are the same";
    EXPECT_EQ(get(fmt::format("{}/{}", chunk_bucket, klot_key(23, 'I'))).status, 404U);
}

TEST_F(S3Chunks, DirectoriesAreStationsAndVolumeNumbers) {
    served_->take_chunks(20);
    // KABR and a volume of KTLX are compressed as a whole, so they have no chunks.
    EXPECT_EQ(prefixes("?list-type=2&delimiter=/"), (Texts{"KLOT/", "KTLX/"}));
    EXPECT_EQ(prefixes("?list-type=2&delimiter=/&prefix=KTLX/"), Texts{"KTLX/607/"});
    const Texts all = keys("?list-type=2&delimiter=/&prefix=KTLX/607/");
    ASSERT_GT(all.size(), 1U);
    EXPECT_EQ(all[0], "KTLX/607/20170101-030027-001-S");
    EXPECT_EQ(keys("?list-type=2&prefix=KTLX/607/&max-keys=1"), Texts{all[0]});
    EXPECT_EQ(keys("?list-type=2&prefix=KTLX/607/&delimiter=/&max-keys=1"), Texts{all[0]});
    EXPECT_NE(texts("?list-type=2&prefix=KTLX/607/&delimiter=/&max-keys=1", "Contents/Size"),
              Texts{"0"});
    EXPECT_EQ(keys("?list-type=2&prefix=KTLX/608/"), Texts{});
    EXPECT_EQ(keys("?list-type=2&prefix=XXXX/"), Texts{});
    // Pages of three keys are the list of all keys.
    Texts paged;
    std::string token;
    do {
        const std::string query = "?list-type=2&max-keys=3&continuation-token=" + token;
        for (std::string& key : keys(query))
            paged.push_back(std::move(key));
        const Texts next = texts(query, "NextContinuationToken");
        token = next.empty() ? "" : next[0];
    } while (!token.empty());
    EXPECT_EQ(paged, keys("?list-type=2"));
    EXPECT_EQ(paged.size(), all.size() + 20);
}

TEST_F(S3Chunks, TheBytesOfAVolumeAreThoseOfItsChunks) {
    std::string joined;
    for (const std::string& key : keys("?list-type=2&prefix=KTLX/"))
        joined += body_of(get(fmt::format("{}/{}", chunk_bucket, key)));
    EXPECT_EQ(joined, body_of(get("/s3/unidata-nexrad-level2/2017/01/01/KTLX/"
                                  "KTLX20170101_030027_V06")));
}

TEST_F(S3Chunks, HasTheNameOfTheBucketOfVolumes) {
    EXPECT_EQ(get("/s3/noaa-nexrad-level2-chunks?list-type=2").status, 200U);
    S3Door other(served_->files(), "my-bucket");
    EXPECT_EQ(asked(other, "/s3/my-bucket-chunks?list-type=2").status, 200U);
    EXPECT_EQ(asked(other, std::string{chunk_bucket} + "?list-type=2").status, 404U);
    EXPECT_EQ(get("/s3/-chunks?list-type=2").status, 404U);
}

TEST(S3ChunkKeys, OnlyKeysOfTheBucketAreKeys) {
    const auto key = parse_s3_chunk_key("KLOT/901/20260328-201457-055-E");
    ASSERT_TRUE(key);
    EXPECT_EQ(key->station, "KLOT");
    EXPECT_EQ(key->volume, 901);
    EXPECT_EQ(format_utc(key->start), "2026-03-28T20:14:57Z");
    EXPECT_EQ(key->number, 55);
    EXPECT_EQ(key->kind, level2::ChunkKind::end);
    for (const char* text : {"", "KLOT", "KLOT/901", "KLOT/901/", "KLOT/901/20260328-201457-55-E",
                             "KLOT/0901/20260328-201457-055-E", "KLOT/1000/20260328-201457-055-E",
                             "KLOT/0/20260328-201457-055-E", "KLOT/x/20260328-201457-055-E",
                             "KLOT/901/20261328-201457-055-E", "KLOT/901/20260328-201457-055-X",
                             "KLOT/901/20260328-201457-000-S", "KLOT/901/20260328-201457-1000-I",
                             "KLOT/901/20260328_201457-055-E", "KLOT/901/20260328-201457-055-E/",
                             "KLOT/901/x20260328-201457-055-E", "/KLOT/901/20260328-201457-055-E"})
        EXPECT_FALSE(parse_s3_chunk_key(text)) << text;
}

// Damaged files of a radar: no part of them may be read as a chunk that is not whole.
TEST(S3ChunksOf, LeavesOutWhatIsNotWhole) {
    const auto count = [](std::string bytes) {
        OpenedVolume volume;
        volume.volume.is_complete = true;
        volume.bytes = {text_of(std::move(bytes))};
        return chunks_of(volume).size();
    };
    const std::string header = std::string("AR2V0006.901") + std::string(12, '\0');
    const std::string record = std::string("\0\0\0\x08", 4) + "BZh9....";
    EXPECT_EQ(count(""), 0U);
    EXPECT_EQ(count(header), 0U);
    EXPECT_EQ(count(header + record), 1U);
    EXPECT_EQ(count(header + record + record), 2U);
    EXPECT_EQ(count(header + record + std::string("\xff\xff\xff\xf8", 4) + "BZh9...."), 2U);
    EXPECT_EQ(count(header + record + record.substr(0, 11)), 1U) << "the last record is cut";
    EXPECT_EQ(count(header + record + std::string("\x7f\xff\xff\xff", 4) + "BZh9"), 1U);
    EXPECT_EQ(count(header + record + std::string("\x80\0\0\0", 4) + "BZh9...."), 1U);
    EXPECT_EQ(count("ARCHIVE2.001" + header.substr(12) + record), 0U);
}

}  // namespace
}  // namespace stormcellar::web
