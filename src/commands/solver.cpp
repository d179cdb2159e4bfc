#include "solver.hpp"

#include "lichtveld/lightfield/thesis.hpp"

namespace lichtveld::commands {

namespace {

template <typename Of>
class SolverOf : public Solver {
 public:
  SolverOf(const gpu::Device& device, const scene::Scene& scene, const lightfield::Settings& settings)
      : method_(device, scene, settings) {}

  lightfield::Solution solve(const std::vector<glm::vec3>& offsets) override { return method_.solve(offsets); }
  std::vector<glm::vec4> irradiance() override { return method_.irradiance(); }
  std::vector<std::uint8_t> presented() override { return method_.presented(); }
  const gpu::PassTimes& times() const override { return method_.times(); }

 protected:
  Of method_;
};

class LinksSolver : public SolverOf<lightfield::Links> {
 public:
  using SolverOf::SolverOf;
  lightfield::Solution update(const std::vector<glm::vec3>& offsets, const Enough& enough) override {
    return method_.update(offsets, enough);
  }
  lightfield::LinkCheck check_links(std::uint32_t pairs) override { return method_.check(pairs); }
};

}  // namespace

const std::vector<Method>& device_methods() {
  static const std::vector<Method> methods = {Method::thesis, Method::links};
  return methods;
}

std::unique_ptr<Solver> make_solver(Method method, const gpu::Device& device, const scene::Scene& scene,
                                    const lightfield::Settings& settings) {
  switch (method) {
    case Method::thesis:
      return std::make_unique<SolverOf<lightfield::Thesis>>(device, scene, settings);
    case Method::links:
      return std::make_unique<LinksSolver>(device, scene, settings);
    case Method::reference:
      break;
  }
  throw std::logic_error("method " + name_of(method) + " does not run on a device");
}

}  // namespace lichtveld::commands
