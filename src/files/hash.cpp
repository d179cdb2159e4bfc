#include "lichtveld/files/hash.hpp"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <system_error>

namespace lichtveld::files {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& why) {
  throw std::runtime_error("cannot hash " + file.string() + ": " + why);
}

std::string hex_of(std::span<const unsigned char> digest) {
  constexpr char digits[] = "0123456789abcdef";
  std::string hex;
  for (const unsigned char byte : digest) {
    hex += digits[byte >> 4];
    hex += digits[byte & 15];
  }
  return hex;
}

}  // namespace

std::string sha256_of(std::span<const std::uint8_t> bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("OpenSSL's SHA-256 failed");
  return hex_of({digest.data(), length});
}

std::string sha256_of_file(const std::filesystem::path& file) {
  // A folder opens as a stream on Linux and only fails when it is read, with a message that helps nobody.
  if (std::filesystem::is_directory(file)) fail(file, "it is a folder; give the scene file");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) fail(file, std::generic_category().message(errno));

  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1)
    fail(file, "OpenSSL has no SHA-256");

  std::array<char, 65536> chunk{};
  while (in) {
    in.read(chunk.data(), chunk.size());
    if (EVP_DigestUpdate(context.get(), chunk.data(), static_cast<std::size_t>(in.gcount())) != 1)
      fail(file, "OpenSSL's SHA-256 failed");
  }
  if (!in.eof()) fail(file, "it could not be read to its end");

  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  if (EVP_DigestFinal_ex(context.get(), digest.data(), &length) != 1) fail(file, "OpenSSL's SHA-256 failed");
  return hex_of({digest.data(), length});
}

}  // namespace lichtveld::files
