#include "bunzip/block_decoder.h"

#include "bunzip/symbol_reader.h"

namespace stormcellar::bunzip {

namespace {

// A block has one empty run and runs of one or more bytes. The size is checked after each batch, so
// a batch may make more runs than a block can have.
constexpr std::size_t most_runs = most_rows + 2 + SymbolReader::batch_symbols;
constexpr std::size_t most_links = most_rows + 1 + link_slack;

}  // namespace

BlockDecoder::BlockDecoder()
    : runs_(std::make_unique_for_overwrite<ByteRun[]>(most_runs)),
      links_(std::make_unique_for_overwrite<Link[]>(most_links)),
      room_(std::make_unique_for_overwrite<std::uint8_t[]>(most_rows + 1)) {}

Found BlockDecoder::read_runs(BitReader& reader, std::uint32_t most_bytes, Path path) {
    run_count_ = 0;
    maker_.begin(std::span{tables_.bytes}.first(tables_.byte_count));
    const MakeRuns make_runs = make_runs_by(path);
    SymbolReader symbols(reader, tables_);
    while (!symbols.ended()) {
        const auto batch = symbols.next_batch();
        run_count_ += make_runs(maker_, batch, runs_.get() + run_count_);
        // `bytes` does not count the run that continues; `times` counts the first byte of this run.
        if (maker_.bytes + maker_.times > most_bytes) return Found::bad;
        if (symbols.found() != Found::good) return symbols.found();
    }
    runs_[run_count_++] = last_run(maker_);
    return maker_.bytes > most_bytes ? Found::bad : Found::good;
}

Found BlockDecoder::read(BitReader& reader, std::uint32_t most_bytes, Path path) {
    bytes_ = {};
    const auto randomised = reader.read(1);
    if (!randomised) return Found::cut;
    const auto origin = reader.read(24);
    if (!origin) return Found::cut;
    if (*origin > most_bytes + 10) return Found::bad;
    if (*randomised != 0) return Found::randomised;
    if (const Found found = tables_.read(reader); found != Found::good) return found;
    if (const Found found = read_runs(reader, most_bytes, path); found != Found::good) return found;
    const auto rows = static_cast<std::uint32_t>(maker_.bytes);
    if (*origin >= rows) return Found::bad;
    link_rows_by(path)({runs_.get(), run_count_}, maker_.count, links_.get());
    const std::span bytes{room_.get(), std::size_t{rows} + 1};
    walk_.read({links_.get(), most_links}, rows, *origin, bytes);
    bytes_ = bytes;
    return Found::good;
}

}  // namespace stormcellar::bunzip
