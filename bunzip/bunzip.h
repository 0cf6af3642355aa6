// bunzip/bunzip.h -- decompresses bzip2 streams, piece by piece or as a whole.
//
//   bunzip::Workspace workspace;             // keep it, one for each thread
//   bunzip::Reader reader(stream, workspace);
//   while (!reader.ended()) use(buffer, reader.read(buffer));
//   if (reader.status() != bunzip::Status::whole) ...
//
// Results   The same bytes as from libbz2, and the same Status for a stream that is not valid.
//           Checksums of blocks and of the stream are always checked. libbz2 itself reads streams
//           with randomized blocks. With Path::libbz2, it reads all streams.
// Safety    Nothing is read outside `stream` or written outside `out`, whatever the stream holds. A
//           Reader may return bytes and find only later that they are corrupt. The caller
//           must bound the output, because one byte of input can make about 2 MB.
// Memory    A Workspace takes 10.2 MB at most, for blocks of 900,000 bytes. While libbz2 reads a
//           stream, its Reader takes 3.7 MB more. Without enough memory, the functions throw
//           std::bad_alloc; a Reader that has thrown must not be used any more.
// Speed     docs/performance.md has the figures; docs/bunzip.md explains the method.
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
    too_large,  // the output is longer than the limit; a Reader never returns this
};

class BlockDecoder;

// The memory for decompressing, kept from stream to stream. A Workspace is empty until its first
// use.
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
    // `stream` and `workspace` must outlive the reader. A workspace may serve one reader at a time.
    // This machine must support `path`.
    Reader(std::span<const std::byte> stream, Workspace& workspace, Path path = usual_path());
    Reader(Reader&&) noexcept;
    Reader& operator=(Reader&&) noexcept;
    ~Reader();

    // Writes the next bytes to `out` and returns their number. Fills `out` unless the stream ends.
    [[nodiscard]] std::size_t read(std::span<std::byte> out);
    [[nodiscard]] bool ended() const;
    // Returns whole, truncated or corrupt, depending on how the stream ended. Returns whole before
    // the end.
    [[nodiscard]] Status status() const;
    // Returns the number of bytes read from `stream` so far. If the stream ended whole, the next
    // stream may begin after them.
    [[nodiscard]] std::size_t input_bytes() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

struct Outcome {
    Status status = Status::whole;
    std::size_t output_bytes = 0;  // written to the start of the buffer
    std::size_t input_bytes = 0;
};

// Decompresses one stream to the start of `buffer`, which grows as needed up to `limit` and never
// shrinks. Returns too_large if the output is longer than `limit`.
[[nodiscard]] Outcome decompress(std::span<const std::byte> stream, std::vector<std::byte>& buffer,
                                 std::size_t limit, Workspace& workspace, Path path = usual_path());

// One of many streams to decompress.
struct Job {
    std::span<const std::byte> stream;
    std::vector<std::byte> output;  // as `buffer` of decompress()
    Outcome outcome = {};
};
// Decompresses the stream of each job as decompress() does. Uses one thread for each workspace,
// including the calling thread; if the system has too few threads, fewer do the work. Without
// workspaces, the caller does all jobs alone. Throws std::bad_alloc if memory was too little for a
// job; the outcomes are then invalid.
void decompress_all(std::span<Job> jobs, std::size_t limit, std::span<Workspace> workspaces,
                    Path path = usual_path());

}  // namespace stormcellar::bunzip
