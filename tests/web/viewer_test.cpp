// Tests the files of the viewer that a browser gets, and the policy for them.
#include "web/doors/viewer/viewer.h"

#include <gtest/gtest.h>
#include <libdeflate.h>

#include "tests/web/asked.h"
#include "web/doors/viewer/viewer_files.h"
#include "web/http/common_headers.h"

namespace stormcellar::web {
namespace {

class Viewer : public ::testing::Test {
  protected:
    void SetUp() override {
        if (viewer_files().empty()) GTEST_SKIP() << "built without the viewer";
    }
    Answer get(const std::string& target, Fields headers = {}) {
        return asked(door_, target, std::move(headers));
    }
    ViewerDoor door_;
};

TEST_F(Viewer, ThePageNamesOnlyFilesThatThereAre) {
    const Answer page = get("/view/");
    ASSERT_EQ(page.status, 200u);
    EXPECT_EQ(header_of(page, "Content-Type"), "text/html; charset=utf-8");
    const std::string text = body_of(page);
    int count = 0;
    for (const std::string_view before : {"href=\"", "src=\""}) {
        for (auto at = text.find(before); at != std::string::npos; at = text.find(before, at + 1)) {
            const auto from = at + before.size();
            const std::string name = text.substr(from, text.find('"', from) - from);
            // The page requests these files early; other handlers of the server answer them.
            if (name.starts_with("data:") || name.starts_with("../api/")) continue;
            EXPECT_EQ(get("/view/" + name).status, 200u) << name;
            ++count;
        }
    }
    EXPECT_EQ(count, 2);
    EXPECT_NE(body_of(get("/view/viewer.js")).find("worker.js"), std::string::npos);
    EXPECT_EQ(get("/view/worker.js").status, 200u);
}

TEST_F(Viewer, ItsPolicyLetsItAskThisServerAlone) {
    for (const char* target : {"/view/", "/view/viewer.js", "/view/editor.js", "/view/layers.js",
                               "/view/map.js", "/view/panels.js", "/view/worker.js"}) {
        Answer answer = get(target);
        add_common_headers(answer, request_for(target), {});
        const std::string policy = header_of(answer, "Content-Security-Policy");
        EXPECT_TRUE(policy.starts_with("default-src 'none'; script-src 'self'; ")) << target;
        EXPECT_NE(policy.find("connect-src 'self'"), std::string::npos);
        EXPECT_EQ(header_of(answer, "X-Content-Type-Options"), "nosniff");
        EXPECT_EQ(header_of(answer, "Cross-Origin-Embedder-Policy"), "require-corp");
    }
    const std::string page = body_of(get("/view/"));
    EXPECT_EQ(page.find("http:"), std::string::npos) << "the page names no other server";
    EXPECT_EQ(page.find("https:"), std::string::npos);
    EXPECT_EQ(page.find("<style"), std::string::npos)
        << "the policy would refuse a style in the page";
    EXPECT_EQ(page.find("<script>"), std::string::npos);
}

TEST_F(Viewer, FilesAreCompressedAndHaveTags) {
    const std::string whole = body_of(get("/view/viewer.js"));
    const Answer packed = get("/view/viewer.js", {{"Accept-Encoding", "gzip"}});
    EXPECT_EQ(header_of(packed, "Content-Encoding"), "gzip");
    const std::string bytes = body_of(packed);
    EXPECT_LT(bytes.size(), whole.size() / 2);
    std::string back(whole.size(), '\0');
    libdeflate_decompressor* const decompressor = libdeflate_alloc_decompressor();
    EXPECT_EQ(libdeflate_gzip_decompress(decompressor, bytes.data(), bytes.size(), back.data(),
                                         back.size(), nullptr),
              LIBDEFLATE_SUCCESS);
    libdeflate_free_decompressor(decompressor);
    EXPECT_EQ(back, whole);
    const std::string etag = header_of(packed, "ETag");
    EXPECT_EQ(get("/view/viewer.js", {{"Accept-Encoding", "gzip"}, {"If-None-Match", etag}}).status,
              304u);
}

// The first picture of scripts/bench-viewer takes at most 350,000 bytes, and this file is the
// largest part that the page itself adds.
TEST_F(Viewer, TheProgramOfTheFirstPictureIsSmall) {
    const std::string bytes = body_of(get("/view/viewer.js", {{"Accept-Encoding", "gzip, zstd"}}));
    EXPECT_LE(bytes.size(), 70'000u);
    // The page loads these programs after its first picture, or when the user asks for them.
    for (const char* target :
         {"/view/editor.js", "/view/layers.js", "/view/map.js", "/view/panels.js"})
        EXPECT_EQ(get(target).status, 200u) << target;
}

TEST_F(Viewer, NothingElseIsThere) {
    const Answer without_slash = get("/view");
    EXPECT_EQ(without_slash.status, 308u);
    EXPECT_EQ(header_of(without_slash, "Location"), "http://localhost:8090/view/");
    for (const char* target : {"/view/main.ts", "/view/viewer.js/", "/view/a/viewer.js"})
        EXPECT_EQ(get(target).status, 404u) << target;
}

}  // namespace
}  // namespace stormcellar::web
