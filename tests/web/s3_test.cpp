// Tests the bucket of raw volumes with the requests of rclone, awscli and other clients of S3
// (docs/web/raw.md). scripts/check-s3 runs two of these programs.
#include "web/doors/s3/s3.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "tests/web/served_volumes.h"

namespace stormcellar::web {
namespace {

constexpr const char* bucket = "/s3/unidata-nexrad-level2";
const std::string new_key = "2017/01/01/KTLX/KTLX20170101_030027_V06";
const std::string middle_key = "2005/01/01/KABR/KABR20050101_000745.gz";

class S3 : public DoorTest<S3Door> {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        door_ = std::make_unique<S3Door>(served_volumes().files(), "unidata-nexrad-level2");
    }
    // Requests a list with this query, and returns the texts of its elements at this path.
    std::vector<std::string> texts(const std::string& query, const char* path) {
        const Answer answer = get(bucket + query);
        EXPECT_EQ(answer.status, 200U) << query;
        EXPECT_EQ(header_of(answer, "Content-Type"), "application/xml");
        pugi::xml_document document;
        const std::string text = body_of(answer);
        EXPECT_TRUE(document.load_string(text.c_str())) << text;
        std::vector<std::string> found;
        for (const auto& node :
             document.select_nodes(("/ListBucketResult/" + std::string(path)).c_str()))
            found.emplace_back(node.node().child_value());
        return found;
    }
    std::string text(const std::string& query, const char* path) {
        const auto found = texts(query, path);
        return found.size() == 1 ? found[0] : fmt::format("{} of them", found.size());
    }
    std::vector<std::string> keys(const std::string& query) { return texts(query, "Contents/Key"); }
    std::vector<std::string> prefixes(const std::string& query) {
        return texts(query, "CommonPrefixes/Prefix");
    }
};

using Texts = std::vector<std::string>;

TEST_F(S3, HasTheEarlierNameOfThePublicBucket) {
    const std::string earlier = "/s3/noaa-nexrad-level2";
    const Answer list = get(earlier + "?list-type=2");
    EXPECT_EQ(list.status, 200U);
    EXPECT_NE(body_of(list).find("<Name>noaa-nexrad-level2</Name>"), std::string::npos);
    EXPECT_NE(body_of(list).find(middle_key), std::string::npos);
    EXPECT_EQ(body_of(get(earlier + "/" + middle_key)), body_of(get(bucket + ("/" + middle_key))));
    S3Door other(served_volumes().files(), "my-bucket");
    EXPECT_EQ(asked(other, earlier + "?list-type=2").status, 404U);
}

TEST_F(S3, ListsEveryVolumeInTheOrderOfKeys) {
    for (const std::string query : {"?list-type=2", "/?list-type=2", "", "/"}) {
        const auto all = keys(query);
        ASSERT_EQ(all.size(), 3U) << query;
        EXPECT_EQ(all[0].substr(0, 28), "1991/07/20/KTLX/KTLX19910720");
        EXPECT_EQ(all[1], middle_key);
        EXPECT_EQ(all[2], new_key);
        EXPECT_EQ(text(query, "IsTruncated"), "false");
        EXPECT_EQ(text(query, "Name"), "unidata-nexrad-level2");
    }
    EXPECT_EQ(texts("?list-type=2", "Contents/Size"), (Texts{"144853", "153355", "488081"}));
    EXPECT_EQ(text("?list-type=2", "KeyCount"), "3");
    EXPECT_EQ(keys("?list-type=2&prefix=2017/01/01/KTLX/"), Texts{new_key});
    EXPECT_EQ(keys("?list-type=2&prefix=2017/01/01/KTLX/KTLX20170101_0300"), Texts{new_key});
    EXPECT_EQ(keys("?list-type=2&prefix=2017/01/01/KABR/"), Texts{});
    EXPECT_EQ(keys("?list-type=2&start-after=" + middle_key), Texts{new_key});
}

TEST_F(S3, DirectoriesAreCommonPrefixes) {
    EXPECT_EQ(prefixes("?list-type=2&delimiter=/"), (Texts{"1991/", "2005/", "2017/"}));
    EXPECT_EQ(keys("?list-type=2&delimiter=/"), Texts{});
    EXPECT_EQ(prefixes("?list-type=2&delimiter=/&prefix=2017/01/"), Texts{"2017/01/01/"});
    EXPECT_EQ(prefixes("?list-type=2&delimiter=%2F&prefix=2017%2F01%2F01%2F"),
              Texts{"2017/01/01/KTLX/"});
    EXPECT_EQ(keys("?list-type=2&delimiter=/&prefix=2017/01/01/KTLX/"), Texts{new_key});
    // A prefix need not end at a slash.
    EXPECT_EQ(prefixes("?list-type=2&delimiter=/&prefix=20"), (Texts{"2005/", "2017/"}));
}

// 2026-11-28: an archive of a day hid the other files of its station, so the bucket was empty.
TEST_F(S3, MembersOfAnArchiveHideNoFiles) {
    ServedVolumes served;
    for (const std::string station : {"KTLX", "KABC"}) {
        std::vector<catalog::FileFacts> members(600);
        for (std::size_t i = 0; i < members.size(); ++i) {
            members[i].path = served.drop() / fmt::format("day.tar!{}{:03}", station, i);
            members[i].station = station;
            members[i].state = catalog::FileState::complete;
            members[i].volumes.resize(1);
            members[i].volumes[0].start_time = *parse_utc("1991-01-01T00:00:00Z", UtcTime{}) +
                                               std::chrono::days{15} * static_cast<int>(i);
        }
        ASSERT_TRUE(served.catalog().register_files(station, members));
    }
    door_ = std::make_unique<S3Door>(served.files(), "unidata-nexrad-level2");
    EXPECT_EQ(keys("?list-type=2").size(), 3U);
    EXPECT_EQ(prefixes("?list-type=2&delimiter=/"), (Texts{"1991/", "2005/", "2017/"}));
    EXPECT_EQ(keys("?list-type=2&prefix=2017/01/01/KTLX/"), Texts{new_key});
    RawRange newest;
    newest.most = 1;
    newest.newest_first = true;
    const auto files = served.files()->list("KTLX", newest);
    ASSERT_TRUE(files && files->size() == 1);
    EXPECT_EQ((*files)[0].name, "KTLX20170101_030027_V06");
    EXPECT_FALSE(served.catalog().oldest_kept("KABC")->has_value());
    EXPECT_EQ(format_utc(**served.catalog().oldest_kept("KTLX")), "1991-07-20T16:05:18.171Z");
}

class UnreadableFiles final : public RawFiles {
  public:
    Result<std::vector<RawStation>> stations() override {
        return std::vector{raw_station("KTLX", nullptr)};
    }
    Result<std::vector<RawVolume>> list(std::string_view, const RawRange&) override {
        return fail(ErrorCode::permission, "{}: the database cannot be opened, for the test",
                    std::string(64, 'x'));
    }
    OpenedOrMissing open(std::string_view, std::string_view) override {
        return tl::unexpected(RawFailure{RawMissing::trouble, "no"});
    }
    std::optional<OpenedVolume> open_kept(std::string_view, std::string_view) override {
        return std::nullopt;
    }
};

// 2026-11-28: GCC 12 compiled the return of an error so that its text was freed twice, and the
// server ended.
TEST(S3Unreadable, AnErrorOfTheCatalogIsAnAnswer) {
    S3Door door(std::make_shared<UnreadableFiles>(), "unidata-nexrad-level2");
    for (int i = 0; i < 20; ++i) {
        for (const char* const query : {"?list-type=2", "?list-type=2&delimiter=/", "?max-keys=1",
                                        "?list-type=2&prefix=2017/01/01/KTLX/"}) {
            const Answer answer = asked(door, std::string(bucket) + query);
            EXPECT_GE(answer.status, 500U) << query;
        }
    }
}

// The pages of a list, read until there is no token, have each entry once.
TEST_F(S3, PagesHaveEverythingOnce) {
    for (const std::string most : {"1", "2"}) {
        for (const auto& [more, entries] :
             {std::pair{"", "Contents/Key"}, std::pair{"&delimiter=/", "CommonPrefixes/Prefix"}}) {
            const std::string query = "?list-type=2&max-keys=" + most + more;
            Texts all;
            std::string token;
            for (int page = 0; page < 5; ++page) {
                const std::string asked_for =
                    query + (token.empty() ? "" : "&continuation-token=" + encoded(token));
                for (const std::string& entry : texts(asked_for, entries))
                    all.push_back(entry);
                if (text(asked_for, "IsTruncated") == "false") break;
                token = text(asked_for, "NextContinuationToken");
            }
            ASSERT_EQ(all.size(), 3U) << query;
            EXPECT_TRUE(std::ranges::is_sorted(all)) << query;
            EXPECT_EQ(all[2].substr(0, 5), "2017/");
        }
    }
    EXPECT_EQ(keys("?max-keys=1&marker=" + middle_key), Texts{new_key})
        << "list version 1 has a marker";
    EXPECT_EQ(text("?max-keys=2", "NextMarker"), middle_key);
    EXPECT_EQ(keys("?list-type=2&max-keys=0"), Texts{});
}

TEST_F(S3, AnObjectHasTheBytesOfTheFile) {
    const auto bytes =
        read_file(*testing::data_directory() / "volumes/KTLX20170101_030027_V06").value();
    const std::string whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string object = std::string(bucket) + "/" + new_key;
    const Answer answer = get(object);
    EXPECT_EQ(answer.status, 200U);
    EXPECT_TRUE(body_of(answer) == whole);
    const std::string tag = header_of(answer, "ETag");
    EXPECT_NE(tag.find('-'), tag.npos) << "no client may take the tag for an MD5";
    EXPECT_EQ(texts("?list-type=2", "Contents/ETag").at(2), tag);
    const Answer part = get(object, {{"Range", "bytes=24-27"}});
    EXPECT_EQ(part.status, 206U);
    EXPECT_EQ(body_of(part), whole.substr(24, 4));
    EXPECT_EQ(get(object, {{"If-None-Match", tag}}).status, 304U);
    EXPECT_EQ(get(object, {{"If-Match", "\"another\""}}).status, 412U);
    // The server ignores signatures.
    EXPECT_EQ(get(object, {{"Authorization", "AWS4-HMAC-SHA256 Credential=a, Signature=b"}}).status,
              200U);
    EXPECT_EQ(get(object + "?X-Amz-Signature=abc&x-id=GetObject").status, 200U);
}

TEST_F(S3, TellsOfBucketsAndWhereTheyAre) {
    EXPECT_NE(body_of(get("/s3")).find("<Name>unidata-nexrad-level2</Name>"), std::string::npos);
    EXPECT_NE(body_of(get(std::string(bucket) + "?location")).find("<LocationConstraint"),
              std::string::npos);
    Request head = request_for(bucket);
    head.verb = Verb::head;
    EXPECT_EQ(header_of(door_->answer(head), "x-amz-bucket-region"), "us-east-1");
}

TEST_F(S3, RefusesInTheWordsOfS3) {
    const std::string object = std::string(bucket) + "/" + new_key;
    const std::vector<std::tuple<std::string, unsigned, std::string>> refusals = {
        {"/s3/another", 404, "NoSuchBucket"},
        {"/s3/another/" + new_key, 404, "NoSuchBucket"},
        {object + "x", 404, "NoSuchKey"},
        {object + "/", 404, "NoSuchKey"},
        {std::string(bucket) + "/2017/01/02/KTLX/KTLX20170101_030027_V06", 404, "NoSuchKey"},
        {std::string(bucket) + "/2017/13/01/KTLX/x", 404, "NoSuchKey"},
        {std::string(bucket) + "/x", 404, "NoSuchKey"},
        {std::string(bucket) + "?acl", 501, "NotImplemented"},
        {object + "?tagging", 501, "NotImplemented"},
        {std::string(bucket) + "?list-type=2&max-keys=many", 400, "InvalidArgument"},
        {std::string(bucket) + "?list-type=2&encoding-type=other", 400, "InvalidArgument"},
    };
    for (const auto& [target, status, code] : refusals) {
        const Answer answer = get(target);
        EXPECT_EQ(answer.status, status) << target;
        EXPECT_NE(body_of(answer).find("<Code>" + code + "</Code>"), std::string::npos) << target;
    }
    // 2026-11-27: while the file was still open from the previous request, the body of a refusal
    // did not have the form of S3.
    EXPECT_EQ(get(object).status, 200U);
    const Answer beyond = get(object, {{"Range", "bytes=488081-"}});
    EXPECT_EQ(beyond.status, 416U);
    EXPECT_EQ(header_of(beyond, "Content-Range"), "bytes */488081");
    EXPECT_NE(body_of(beyond).find("<Code>InvalidRange</Code>"), std::string::npos);
}

}  // namespace
}  // namespace stormcellar::web
