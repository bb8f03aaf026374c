// The two checksums of the spool: SHA-256 for what must not be forged unnoticed (ledger rows, a job's content), CRC-32
// for what may rot on the disk (pages).
#pragma once

#include "base/record_page.hpp"
#include "spool/job.hpp"

#include <openssl/evp.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace linefeed::spool {

using Sha256Digest = std::array<unsigned char, 32>;

/// SHA-256 of bytes that come in pieces. Flow: update() …, then finish() once.
class Sha256 {
public:
    Sha256();
    void update(std::string_view bytes);
    [[nodiscard]] Sha256Digest finish();

private:
    struct Deleter {
        void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
    };
    std::unique_ptr<EVP_MD_CTX, Deleter> context_;
};

/// Lower-case hex digits of bytes.
[[nodiscard]] std::string to_hex(std::string_view bytes);

/// SHA-256 of bytes that are there as a whole, as such digits.
[[nodiscard]] std::string sha256_hex(std::string_view bytes);

/// CRC-32 over the job, the first number, the offsets and the frames of a page: a page in the wrong place does not pass
/// either. `packed_ends` is the form in which the offsets are stored.
[[nodiscard]] std::uint32_t page_checksum(JobId job, RecordNumber first, std::string_view packed_ends,
                                          std::string_view frames);

} // namespace linefeed::spool
