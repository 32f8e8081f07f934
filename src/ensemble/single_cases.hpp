// Runs one by one, by elements or modes, with mechanisms where linear vehicles are not accurate enough.
#pragma once

#include <map>

#include "ensemble/engines.hpp"
#include "run/simulation.hpp"

namespace traverse::ensemble {

class SingleEngine : public Engine {
 public:
  /// The cases must outlive this object.
  explicit SingleEngine(CaseSet& cases);

  std::vector<CaseResult> run(std::size_t train, std::span<const Member> members,
                              const std::function<void(double)>& reached) override;
  double cost() const override;

 private:
  CaseResult run(const scene::Scene& scene, std::size_t train, const CaseRun& run,
                 const std::function<void(double)>& reached) const;

  CaseSet& cases_;
  bool by_batch_kernel_ = false;                                          // single runs use the kernel of batches
  mutable std::map<std::size_t, std::vector<double>> static_deflection_;  // m, for each train
};

}  // namespace traverse::ensemble
