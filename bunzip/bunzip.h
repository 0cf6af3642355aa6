// bunzip/bunzip.h -- bzip2 decompressed fast: a stream piece by piece, or whole.
//
//   bunzip::Workspace workspace;             // kept, one a thread
//   bunzip::Reader reader(stream, workspace);
//   while (!reader.ended()) use(buffer, reader.read(buffer));
//   if (reader.status() != bunzip::Status::whole) ...
//
// Right      as libbz2: the same bytes, and of a stream that is not valid the same Status.
// Checksums
//            of blocks and of the stream are always checked. libbz2 itself reads randomised blocks,
//            and everything where Path::libbz2 is asked for.
// Safe       never reads outside `stream` nor writes outside `out`, whatever the stream holds; what
//            is given out before the end may still turn out to be corrupt. Output is bounded by
//            what the caller gives room for: a byte can stand for some 2 MB.
// Memory     a Workspace: 10.2 MB at most, for blocks of 900,000 bytes; while libbz2 reads a
//            randomised stream, its 3.7 besides. What cannot be had is thrown as std::bad_alloc;
//            a Reader that has thrown is not to be read on.
// Speed      docs/performance.md; how it works: docs/bunzip.md.
// Thread contract: a Workspace and its Reader belong to one thread.
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
    corrupt,    // they contradict the format or a checksum
    too_large,  // more output than the limit
};

class BlockDecoder;

// What decompressing takes, kept from stream to stream. Empty until it is first used.
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

// One stream. What follows it is not looked at.
class Reader {
  public:
    // Both must outlive the reader; one reader a workspace at a time. `path` is one that this
    // machine has.
    Reader(std::span<const std::byte> stream, Workspace& workspace, Path path = usual_path());
    Reader(Reader&&) noexcept;
    Reader& operator=(Reader&&) noexcept;
    ~Reader();

    // Fills `out` as far as the stream goes and says how many bytes; fewer only at its end.
    [[nodiscard]] std::size_t read(std::span<std::byte> out);
    [[nodiscard]] bool ended() const;
    // What ended it: whole, truncated or corrupt. Whole until then.
    [[nodiscard]] Status status() const;
    // That the stream took so far, and in all once it has ended whole.
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

// One stream into `buffer`, which grows as needed up to `limit` and never shrinks.
[[nodiscard]] Outcome decompress(std::span<const std::byte> stream, std::vector<std::byte>& buffer,
                                 std::size_t limit, Workspace& workspace, Path path = usual_path());

// One of many streams.
struct Job {
    std::span<const std::byte> stream;
    std::vector<std::byte> output;  // grows as needed and never shrinks
    Outcome outcome = {};
};
// Each job, as decompress() does it, by a thread for each workspace, of which the caller is one;
// fewer where the system has no more. With no workspace the caller does them all in one of its own.
// Throws std::bad_alloc where a job could not be done for want of memory; no outcome counts then.
void decompress_all(std::span<Job> jobs, std::size_t limit, std::span<Workspace> workspaces,
                    Path path = usual_path());

}  // namespace stormcellar::bunzip
