// Mutants of small files, one for each thing that exporters write, through what `lichtveld check` and
// `lichtveld bake` do: no crash, no hang, no half-written file, no number that is none.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "examine.hpp"
#include "mutate.hpp"
#include "scene_builder.hpp"
#include "seeds.hpp"
#include "watchdog.hpp"

namespace lichtveld::mutants {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::uint64_t count = 10'000, first = 0;
  std::string seed_file;
  std::string keep;             // a folder for the files of mutants with faults
  unsigned limit = 30;          // seconds a mutant
  std::uint64_t memory = 1536;  // MiB that a mutant may take at once
  bool show = false;
};

// MiB of the process: now, and at most since the last call of forget_most().
std::uint64_t status_mib(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (std::uint64_t kib = 0; word == key && status >> kib) return kib >> 10;
  return 0;
}

void forget_most() {
  std::ofstream("/proc/self/clear_refs") << 5;
}

struct Tally {
  std::uint64_t baked = 0, refused = 0, faults = 0;
  double longest = 0;  // [s]
  std::uint64_t longest_at = 0, most_memory = 0;
  std::map<std::string, int> messages;
};

// Numbers in a message differ from mutant to mutant.
std::string kind_of(const std::string& message) {
  std::string kind;
  bool in_number = false, in_quotes = false;
  for (const char c : message) {
    const bool digit = (c >= '0' && c <= '9') || (in_number && c == '.');
    if (c == '"') in_quotes = !in_quotes;
    if (digit ? !in_number && !in_quotes : !in_quotes || c == '"') kind += digit ? '#' : c;
    in_number = digit;
  }
  return kind.substr(0, 110);
}

void keep(const Mutant& mutant, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const auto& [name, bytes] : mutant.files) std::ofstream(folder / name, std::ios::binary) << bytes;
}

class Run {
 public:
  explicit Run(const Options& options) : options_(options), watchdog_(std::chrono::seconds(options.limit)) {}

  // Whether nothing is wrong with any.
  bool all(const std::vector<Seed>& seeds) {
    for (std::uint64_t i = 0; i < options_.count; ++i)
      one(seeds[i % seeds.size()], options_.first + i / seeds.size());
    return summary(seeds);
  }

 private:
  void one(const Seed& seed, std::uint64_t number) {
    const auto mutant = mutant_of(seed, number);
    const std::string name =
        fmt::format("--seed-file {} --first {} --count 1 ({})", seed.name, number, mutant.done);
    if (options_.show) fmt::print("{}\n", name);
    Tally& tally = tallies_[seed.name];
    forget_most();
    const auto before = status_mib("VmRSS:");
    const auto start = Clock::now();
    watchdog_.begin(name);
    const auto turn = number + seed.name.size();  // not of all seed files at once
    auto verdict = examine(mutant, folder_.path(), device_,
                           {.trial = turn % 64 == 10, .shown = turn % 16 == 5, .unwrapped = turn % 2 == 0},
                           &Watchdog::doing);
    watchdog_.end();
    const double took = std::chrono::duration<double>(Clock::now() - start).count();
    const auto most = status_mib("VmHWM:"), more = most > before ? most - before : 0;
    if (more > options_.memory) verdict.faults.push_back(fmt::format("took {} MiB", more));
    if (number == 0 && !verdict.refusal.empty())
      verdict.faults.push_back("the seed is refused: " + verdict.refusal);
    if (took > tally.longest) tally.longest = took, tally.longest_at = number;
    tally.most_memory = std::max(tally.most_memory, more);
    verdict.refusal.empty() ? ++tally.baked : ++tally.refused;
    if (!verdict.refusal.empty()) ++tally.messages[kind_of(verdict.refusal)];
    if (options_.show)
      fmt::print("  {:.2f} s, {} MiB: {}\n", took, more, verdict.refusal.empty() ? "baked" : verdict.refusal);
    for (const auto& fault : verdict.faults) fmt::print("{}\n  {}\n", name, fault);
    tally.faults += verdict.faults.size();
    if (!options_.keep.empty() && !verdict.faults.empty())
      keep(mutant, std::filesystem::path(options_.keep) / fmt::format("{}-{}", seed.name, number));
    std::fflush(stdout);
  }

  bool summary(const std::vector<Seed>& seeds) const {
    std::uint64_t baked = 0, refused = 0, faults = 0;
    for (const auto& seed : seeds) {
      const auto found = tallies_.find(seed.name);
      if (found == tallies_.end()) continue;
      const Tally& tally = found->second;
      baked += tally.baked, refused += tally.refused, faults += tally.faults;
      fmt::print("{:20} {:5} baked, {:5} refused, {} faults; at most {:.1f} s (--first {}), {} MiB\n",
                 seed.name, tally.baked, tally.refused, tally.faults, tally.longest, tally.longest_at,
                 tally.most_memory);
      std::vector<std::pair<std::string, int>> messages(tally.messages.begin(), tally.messages.end());
      std::ranges::stable_sort(messages, std::greater{}, &std::pair<std::string, int>::second);
      for (std::size_t i = 0; i < std::min<std::size_t>(messages.size(), 3); ++i)
        fmt::print("    {:4} x {}\n", messages[i].second, messages[i].first);
    }
    fmt::print("{} baked, {} refused, {} faults\n", baked, refused, faults);
    return faults == 0;
  }

  const Options options_;
  const testing::TempFolder folder_;
  const gpu::Device device_{{.device = "llvmpipe"}};
  std::map<std::string, Tally> tallies_;
  Watchdog watchdog_;
};

int run(int argc, char** argv) {
  Options options;
  CLI::App application("Mutants of scenes through what check and bake do");
  application.add_option("--count", options.count, "Mutants, shared out among the seed files")
      ->capture_default_str();
  application
      .add_option("--first", options.first, "The number of each seed file's first mutant; 0 is the file itself")
      ->capture_default_str();
  application.add_option("--seed-file", options.seed_file, "Of this one alone");
  application.add_option("--limit", options.limit, "Seconds that a mutant may take")->capture_default_str();
  application.add_option("--memory", options.memory, "MiB that it may take")->capture_default_str();
  application.add_option("--keep", options.keep, "A folder in which the files of mutants with faults are kept");
  application.add_flag("--show", options.show, "Say of each what was done to it and what came of it");
  CLI11_PARSE(application, argc, argv);
  auto all = seeds();
  if (!options.seed_file.empty()) {
    std::string names;
    for (const auto& seed : all) names += " " + seed.name;
    std::erase_if(all, [&](const Seed& seed) { return seed.name != options.seed_file; });
    if (all.empty()) {
      fmt::print(stderr, "--seed-file {}: there are{}\n", options.seed_file, names);
      return 2;
    }
  }
  return Run(options).all(all) ? 0 : 1;
}

}  // namespace
}  // namespace lichtveld::mutants

int main(int argc, char** argv) {
  return lichtveld::mutants::run(argc, argv);
}
