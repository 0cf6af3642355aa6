// Tests that machines with the same volumes make the same bytes, although the names, times and
// places of files, their order, and the number of threads differ.
#include <map>

#include <gtest/gtest.h>

#include "pipeline/ingest/ingest.h"
#include "stormcellar/catalog/catalog.h"
#include "tests/pipeline/small_domain.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

using Files = std::map<fs::path, std::vector<std::byte>>;

// The facts that are local to a machine.
struct Local {
    std::string before, behind;  // added to the names of files
    std::chrono::hours age{0};   // age of the first file; each next file is an hour older
    int threads = 1;
    bool newest_first = false;
};

class Machine {
  public:
    explicit Machine(const Local& local) : local_(local) {
        fs::create_directories(drop());
        for (std::size_t i = 0; i < sequence.size(); ++i) {
            const fs::path path = raw(i);
            fs::copy_file(testing::real_file("sequence-kbgm") / sequence[i], path);
            fs::permissions(path, fs::perms::owner_write, fs::perm_options::add);
            fs::last_write_time(
                path, fs::file_time_type::clock::now() - local.age * static_cast<int>(i + 1));
        }
    }
    void take_all() {
        IngestOptions options;
        options.moments = {level2::Moment::ref, level2::Moment::vel};
        options.spacing_m = 4000;
        options.nx = options.ny = 115;
        options.domains = {small_domain()};
        options.decode_threads = options.grid_threads = local_.threads;
        auto catalog = catalog::CatalogWriter::open(directory_ / "catalog");
        auto store = cache::StoreWriter::open(real_file_system(), directory_ / "cache", true);
        ASSERT_TRUE(catalog && store);
        Ingestor ingestor(*catalog, *store, options);
        for (std::size_t i = 0; i < sequence.size(); ++i) {
            const auto at = local_.newest_first ? sequence.size() - 1 - i : i;
            const auto outcome = ingestor.ingest(raw(at), false);
            ASSERT_TRUE(outcome) << outcome.error().message;
            ASSERT_EQ(outcome->result(), IngestResult::gridded);
        }
    }
    [[nodiscard]] Files cache() const {
        Files files;
        for (const auto& entry : fs::recursive_directory_iterator(directory_ / "cache")) {
            if (entry.is_regular_file())
                files[fs::relative(entry.path(), directory_ / "cache")] = *read_file(entry.path());
        }
        return files;
    }

  private:
    [[nodiscard]] fs::path drop() const { return directory_ / ("drop" + local_.before); }
    [[nodiscard]] fs::path raw(std::size_t number) const {
        return drop() / (local_.before + sequence.at(number).substr(0, 19) + local_.behind);
    }
    Local local_;
    testing::TemporaryDirectory directory_;
};

TEST(SameBytes, OfTheSameVolumesWhateverIsLocal) {
    STORMCELLAR_NEED_DATA();
    Machine here(Local{"", ".gz"});
    Machine there(Local{"6500", "_V06.gz", std::chrono::hours{5}, 3, true});
    here.take_all();
    there.take_all();
    const Files ours = here.cache(), theirs = there.cache();
    std::size_t frames = 0;
    for (const auto& [path, bytes] : ours) {
        if (path.native().starts_with("north/")) ++frames;
        ASSERT_TRUE(theirs.contains(path)) << path;
        EXPECT_TRUE(bytes == theirs.at(path)) << path;
    }
    EXPECT_EQ(ours.size(), theirs.size());
    EXPECT_EQ(ours.size(), 11U) << "6 grids of three volumes, 3 partials and 2 frames";
    EXPECT_EQ(frames, 2U);
}

}  // namespace
}  // namespace stormcellar::pipeline
