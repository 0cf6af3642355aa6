#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"
#include "tests/web/asked.h"
#include "web/http/answer.h"

namespace stormcellar::web {
namespace {

const UtcTime changed = *parse_utc("2022-03-17T00:08:42.596Z", now_utc());

Entity ten_bytes() {
    Entity entity;
    entity.bytes = {text_of("0123"), text_of("456789")};
    entity.content_type = "text/x-ten";
    entity.etag = "\"ten\"";
    entity.modified = changed;
    return entity;
}

Answer ten_bytes_asked(Fields headers) {
    Request request;
    request.headers = std::move(headers);
    return answer_with(request, ten_bytes());
}

TEST(Entity, IsSentWhole) {
    const Answer answer = ten_bytes_asked({});
    EXPECT_EQ(answer.status, 200u);
    EXPECT_EQ(body_of(answer), "0123456789");
    EXPECT_EQ(header_of(answer, "ETag"), "\"ten\"");
    EXPECT_EQ(header_of(answer, "Last-Modified"), "Thu, 17 Mar 2022 00:08:42 GMT");
    EXPECT_EQ(header_of(answer, "Accept-Ranges"), "bytes");
    EXPECT_EQ(header_of(answer, "Cache-Control"), "no-cache");
}

TEST(Entity, OneRange) {
    const auto expect = [](const char* range, const char* body, const char* content_range) {
        const Answer answer = ten_bytes_asked({{"Range", range}});
        EXPECT_EQ(answer.status, 206u) << range;
        EXPECT_EQ(body_of(answer), body) << range;
        EXPECT_EQ(header_of(answer, "Content-Range"), content_range) << range;
        EXPECT_EQ(header_of(answer, "Content-Type"), "text/x-ten");
    };
    expect("bytes=0-0", "0", "bytes 0-0/10");
    expect("bytes=3-4", "34", "bytes 3-4/10");
    expect("bytes=7-", "789", "bytes 7-9/10");
    expect("bytes=-2", "89", "bytes 8-9/10");
    expect("bytes=-20", "0123456789", "bytes 0-9/10");
    expect("bytes=8-99999999999999999999999", "89", "bytes 8-9/10");
    expect("bytes=99-,8-", "89", "bytes 8-9/10");
}

TEST(Entity, SeveralRanges) {
    const Answer answer = ten_bytes_asked({{"Range", "bytes=1-2, 8-"}});
    EXPECT_EQ(answer.status, 206u);
    const std::string type = header_of(answer, "Content-Type");
    const std::string boundary = type.substr(type.find('=') + 1);
    EXPECT_EQ(type, "multipart/byteranges; boundary=" + boundary);
    EXPECT_EQ(body_of(answer),
              "\r\n--" + boundary +
                  "\r\nContent-Type: text/x-ten\r\nContent-Range: bytes 1-2/10\r\n\r\n12"
                  "\r\n--" +
                  boundary +
                  "\r\nContent-Type: text/x-ten\r\nContent-Range: bytes 8-9/10\r\n\r\n89"
                  "\r\n--" +
                  boundary + "--\r\n");
}

TEST(Entity, RangesThatTheBytesDoNotHave) {
    for (const char* range : {"bytes=10-", "bytes=10-11", "bytes=-0", "bytes=99-100,50-60"}) {
        const Answer answer = ten_bytes_asked({{"Range", range}});
        EXPECT_EQ(answer.status, 416u) << range;
        EXPECT_EQ(header_of(answer, "Content-Range"), "bytes */10");
    }
}

TEST(Entity, RangesThatMakeNoSenseAreIgnored) {
    std::string many = "bytes=0-0";
    for (int i = 0; i < 17; ++i)
        many += ",1-1";
    for (const std::string& range :
         {std::string{"bytes=3-2"}, std::string{"bytes=a-b"}, std::string{"bytes="},
          std::string{"bytes=-"}, std::string{"lines=1-2"}, std::string{"bytes=1"},
          std::string{"bytes=0-9,0-9"}, std::string{"bytes=--1"}, std::string{"bytes=+1-2"},
          many}) {
        const Answer answer = ten_bytes_asked({{"Range", range}});
        EXPECT_EQ(answer.status, 200u) << range;
        EXPECT_EQ(body_of(answer), "0123456789");
    }
}

TEST(Entity, IfRangeSendsThePartOfTheSameVersionAlone) {
    const auto status = [](const char* version) {
        return ten_bytes_asked({{"Range", "bytes=0-0"}, {"If-Range", version}}).status;
    };
    EXPECT_EQ(status("\"ten\""), 206u);
    EXPECT_EQ(status("\"eleven\""), 200u);
    EXPECT_EQ(status("W/\"ten\""), 200u);
    EXPECT_EQ(status("Thu, 17 Mar 2022 00:08:42 GMT"), 206u);
    EXPECT_EQ(status("Thu, 17 Mar 2022 00:08:43 GMT"), 200u);
    EXPECT_EQ(status("yesterday"), 200u);
}

TEST(Entity, IsNotSentAgain) {
    const auto status = [](const char* name, const char* value) {
        return ten_bytes_asked({{name, value}}).status;
    };
    EXPECT_EQ(status("If-None-Match", "\"ten\""), 304u);
    EXPECT_EQ(status("If-None-Match", "\"a\", W/\"ten\""), 304u);
    EXPECT_EQ(status("If-None-Match", "*"), 304u);
    EXPECT_EQ(status("If-None-Match", "\"eleven\""), 200u);
    EXPECT_EQ(status("If-Modified-Since", "Thu, 17 Mar 2022 00:08:42 GMT"), 304u);
    EXPECT_EQ(status("If-Modified-Since", "Thursday, 17-Mar-22 00:08:42 GMT"), 304u);
    EXPECT_EQ(status("If-Modified-Since", "Thu Mar 17 00:08:42 2022"), 304u);
    EXPECT_EQ(status("If-Modified-Since", "Thu, 17 Mar 2022 00:08:41 GMT"), 200u);
    EXPECT_EQ(status("If-Match", "\"ten\""), 200u);
    EXPECT_EQ(status("If-Match", "\"eleven\""), 412u);
    EXPECT_EQ(status("If-Unmodified-Since", "Thu, 17 Mar 2022 00:08:41 GMT"), 412u);
    EXPECT_TRUE(body_of(ten_bytes_asked({{"If-None-Match", "\"ten\""}})).empty());
    EXPECT_EQ(ten_bytes_asked({{"If-None-Match", "\"eleven\""},
                               {"If-Modified-Since", "Thu, 17 Mar 2022 00:08:42 GMT"}})
                  .status,
              200u)
        << "the tag counts more than the date";
}

TEST(Entity, SlicesOfFiles) {
    const testing::TemporaryDirectory directory;
    std::ofstream(directory / "file") << "abcdefghij";
    const auto file =
        std::make_shared<const Descriptor>(::open((directory / "file").c_str(), O_RDONLY));
    Entity entity = ten_bytes();
    entity.bytes = {FileSlice{file, 2, 4}, text_of("-"), FileSlice{file, 0, 2}};
    Request request;
    EXPECT_EQ(body_of(answer_with(request, entity)), "cdef-ab");
    request.headers = {{"Range", "bytes=3-5"}};
    EXPECT_EQ(body_of(answer_with(request, entity)), "f-a");
}

TEST(HttpDate, IsWrittenAndRead) {
    EXPECT_EQ(http_date(changed), "Thu, 17 Mar 2022 00:08:42 GMT");
    const UtcTime seconds = std::chrono::floor<std::chrono::seconds>(changed);
    EXPECT_EQ(parse_http_date("Thu, 17 Mar 2022 00:08:42 GMT"), seconds);
    EXPECT_EQ(parse_http_date("Sun, 06 Nov 1994 08:49:37 GMT"),
              parse_http_date("Sunday, 06-Nov-94 08:49:37 GMT"));
    for (const char* text :
         {"", "now", "Thu, 17 Mar 2022 25:08:42 GMT", "Thu, 31 Feb 2022 00:00:00 GMT",
          "Thu, 17 Mar 2022 00:08:42 GMTx", "Thu, 17 Xyz 2022 00:08:42 GMT"})
        EXPECT_EQ(parse_http_date(text), std::nullopt) << text;
}

TEST(XmlEscaped, LeavesNothingThatXmlReads) {
    EXPECT_EQ(xml_escaped("<a b=\"c\">&'\x01"), "&lt;a b=&quot;c&quot;&gt;&amp;&#39;\xEF\xBF\xBD");
}

}  // namespace
}  // namespace stormcellar::web
