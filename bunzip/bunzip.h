// bunzip/bunzip.h -- decompresses bzip2 fast: a stream piece by piece, or as a whole.
//
//   bunzip::Workspace workspace;             // keep it, one for each thread
//   bunzip::Reader reader(stream, workspace);
//   while (!reader.ended()) use(buffer, reader.read(buffer));
//   if (reader.status() != bunzip::Status::whole) ...
//
// Results   The same as those of libbz2: the same bytes, and the same Status for a stream that is
//           not valid. Checksums of blocks and of the stream are always checked. libbz2 itself
//           reads randomized blocks, and everything with Path::libbz2.
// Safety    Nothing is read outside `stream` or written outside `out`, whatever the stream holds.
//           Bytes that were returned before the end may still turn out to be corrupt. The caller's
//           room bounds the output, because one byte of input can make about 2 MB.
// Memory    A Workspace takes 10.2 MB at most, for blocks of 900,000 bytes. While libbz2 reads a
//           randomized stream, it takes 3.7 MB more. Without enough memory, std::bad_alloc is
//           thrown; a Reader that has thrown must not be used any more.
// Speed     docs/performance.md has the figures, docs/bunzip.md explains how it works.
// Threads   A Workspace and its Reader may be used by one thread at a time.
// Errors    A Status, as below.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bunzip/paths.h"

namespace stormcellar::bunzip {

enum class Status : std::uint8_t {
    whole,
    truncated,  // the bytes end inside the stream
    corrupt,    // the bytes contradict the format or a checksum
    too_large,  // more output than the limit
};

class BlockDecoder;

// The memory for decompressing, kept from stream to stream. It is empty until its first use.
class Workspace {
  public:
    Workspace();
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    ~Workspace();

  private:
    friend class Reader;
    std::unique_ptr<BlockDecoder> blocks_;
};

// Reads one stream, and nothing after it.
class Reader {
  public:
    // Both arguments must outlive the reader. A workspace may serve one reader at a time. This
    // machine must support the path.
    Reader(std::span<const std::byte> stream, Workspace& workspace, Path path = usual_path());
    Reader(Reader&&) noexcept;
    Reader& operator=(Reader&&) noexcept;
    ~Reader();

    // Fills `out` as far as the stream reaches and returns the number of bytes. They are fewer than
    // `out` holds only at the end.
    [[nodiscard]] std::size_t read(std::span<std::byte> out);
    [[nodiscard]] bool ended() const;
    // Returns how the stream ended: whole, truncated or corrupt. Before the end it returns whole.
    [[nodiscard]] Status status() const;
    // Returns the number of bytes read from the stream so far; all its bytes once it has ended
    // whole.
    [[nodiscard]] std::size_t input_bytes() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

struct Outcome {
    Status status = Status::whole;
    std::size_t output_bytes = 0;  // at the start of the buffer
    std::size_t input_bytes = 0;
};

// Decompresses one stream into `buffer`, which grows as needed up to `limit` and never shrinks.
[[nodiscard]] Outcome decompress(std::span<const std::byte> stream, std::vector<std::byte>& buffer,
                                 std::size_t limit, Workspace& workspace, Path path = usual_path());

// One of many streams to decompress.
struct Job {
    std::span<const std::byte> stream;
    std::vector<std::byte> output;  // grows as needed and never shrinks
    Outcome outcome = {};
};
// Does each job in the same way as decompress(), with one thread for each workspace, the caller's
// included, or with fewer threads if the system has no more. Without any workspace the caller does
// all jobs in its own. Throws std::bad_alloc if a job could not be done for lack of memory; then no
// outcome counts.
void decompress_all(std::span<Job> jobs, std::size_t limit, std::span<Workspace> workspaces,
                    Path path = usual_path());

}  // namespace stormcellar::bunzip
