#include "write_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <system_error>
#include <utility>

#include "held_signals.hpp"

namespace lichtveld::files {

namespace {

// Between two pieces of a file a signal is looked for: a slow disk writes this much in a moment [bytes].
constexpr std::size_t piece = 1u << 20;

[[noreturn]] void fail() {
  throw std::system_error(errno, std::generic_category());
}

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& file, int flags)
      : descriptor_(open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | flags, 0666)) {
    if (descriptor_ < 0) fail();
  }
  ~Descriptor() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return descriptor_; }

  // Some file systems (NFS) tell only now that there was no room.
  void finish() {
    if (close(std::exchange(descriptor_, -1)) != 0) fail();
  }

 private:
  int descriptor_;
};

template <typename GoOn>
void write_all(int descriptor, std::span<const std::uint8_t> bytes, const GoOn& go_on) {
  while (!bytes.empty() && go_on()) {
    const auto written = write(descriptor, bytes.data(), std::min(bytes.size(), piece));
    if (written < 0 && errno != EINTR) fail();
    if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void keep_permissions(const std::filesystem::path& old, int descriptor) {
  struct stat was {};
  if (stat(old.c_str(), &was) != 0) return;
  // Only root may give a file away.
  [[maybe_unused]] const int ignored = fchown(descriptor, was.st_uid, was.st_gid);
  if (fchmod(descriptor, was.st_mode & 0777) != 0) fail();
}

}  // namespace

void write_into(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  Descriptor out(file, 0);
  write_all(out.get(), bytes, [] { return true; });
  out.finish();
}

void write_and_rename(const std::filesystem::path& file, std::span<const std::uint8_t> bytes) {
  static std::mutex one_at_a_time;  // HeldSignals
  const std::scoped_lock lock(one_at_a_time);
  // Not made of the file's own name, which may be as long as names can be.
  const auto hidden = file.parent_path() / fmt::format(".lichtveld-{}", getpid());
  const HeldSignals signals;
  unlink(hidden.c_str());  // of a process of this number that was killed
  try {
    Descriptor out(hidden, O_CREAT | O_EXCL);
    write_all(out.get(), bytes, [&] { return !signals.any(); });
    keep_permissions(file, out.get());
    out.finish();
    if (signals.any())
      unlink(hidden.c_str());  // the process ends with `signals`
    else if (rename(hidden.c_str(), file.c_str()) != 0)
      fail();
  } catch (...) {
    unlink(hidden.c_str());
    throw;
  }
}

}  // namespace lichtveld::files
