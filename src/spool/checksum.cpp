#include "spool/checksum.hpp"

#include "base/assert.hpp"

#include <zlib.h>

namespace linefeed::spool {

Sha256::Sha256()
    : context_(EVP_MD_CTX_new()) {
    LINEFEED_ASSERT(context_ != nullptr);
    LINEFEED_ASSERT(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
}

void Sha256::update(std::string_view bytes) {
    LINEFEED_ASSERT(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
}

Sha256Digest Sha256::finish() {
    Sha256Digest digest{};
    LINEFEED_ASSERT(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr) == 1);
    return digest;
}

std::string sha256_hex(std::string_view bytes) {
    Sha256 sum;
    sum.update(bytes);
    const Sha256Digest digest = sum.finish();
    return to_hex({reinterpret_cast<const char*>(digest.data()), digest.size()});
}

std::string to_hex(std::string_view bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    text.reserve(bytes.size() * 2);
    for (const char byte : bytes) {
        const auto value = static_cast<unsigned char>(byte);
        text += digits[value >> 4U];
        text += digits[value & 0x0FU];
    }
    return text;
}

std::uint32_t page_checksum(JobId job, RecordNumber first, std::string_view packed_ends, std::string_view frames) {
    const std::string place =
        std::to_string(static_cast<std::int64_t>(job)) + ' ' + std::to_string(first.value()) + ' ';
    uLong crc = ::crc32(0, nullptr, 0);
    for (const std::string_view part : {std::string_view{place}, packed_ends, frames}) {
        crc = ::crc32_z(crc, reinterpret_cast<const Bytef*>(part.data()), part.size());
    }
    return static_cast<std::uint32_t>(crc);
}

} // namespace linefeed::spool
