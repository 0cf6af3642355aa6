// Lists the volumes of a station that a daemon has cataloged.
#include <cstdio>

#include <stormcellar/catalog/catalog.h>

using namespace stormcellar;

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: query_catalog DIRECTORY STATION\n");
        return 2;
    }
    // A reader never changes anything; the daemon may write at the same time.
    const auto catalog = catalog::CatalogReader::open(argv[1]);
    if (!catalog) {
        std::fprintf(stderr, "%s\n", catalog.error().message.c_str());
        return 1;
    }
    const auto entries = catalog->list(argv[2], catalog::Query{});
    if (!entries) {
        std::fprintf(stderr, "%s\n", entries.error().message.c_str());
        return 1;
    }
    for (const catalog::CatalogEntry& entry : *entries) {
        const auto start = entry.volume.start_time;
        std::printf("%s  %3d sweeps  %s  %s\n", start ? format_utc(*start).c_str() : "no time",
                    entry.volume.sweep_count,
                    std::string(catalog::file_state_name(entry.state)).c_str(), entry.path.c_str());
    }
    return 0;
}
