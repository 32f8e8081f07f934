// Time of the vehicles' part of an implicit stage, per coach: `build/benchmarks/newton_benchmark`.
// Scene: coaches of 10 degrees of freedom on Hertz wheels, 25 m apart, cross isolated spans of 32 m, 10 elements each,
// at 83 m/s; one stage a step (the trapezoidal rule). The second argument is the step in ms. Counters, in processor
// time of this thread: newton, ContactNewton::solve alone; stage, with placing the wheels and the beam's compliance.
#include <benchmark/benchmark.h>
#include <slepceps.h>

#include <cmath>
#include <ctime>
#include <memory>
#include <string>

#include "coupling/system.hpp"
#include "support/folders.hpp"
#include "traverse/options/options.hpp"
#include "traverse/scene/scene.hpp"

namespace {

using namespace traverse;

constexpr int spans = 30;
constexpr double speed = 83.333;

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What one reading of the clock takes, s.
double clock_cost() {
  constexpr int readings = 2000;
  const double begin = processor_time();
  for (int i = 1; i < readings; ++i) benchmark::DoNotOptimize(processor_time());
  return (processor_time() - begin) / readings;
}

train::Vehicle quarter_car() {
  train::Vehicle vehicle;
  vehicle.name = "quarter";
  multibody::Body wheel, body;
  wheel.name = "wheel";
  wheel.mass = 1000.0;
  wheel.inertia = 60.0;
  wheel.position = {0.0, 0.46, 0.0};
  body = wheel;
  body.name = "body";
  body.mass = 9000.0;
  body.position.y() = 1.5;
  multibody::Joint guide;
  guide.name = "guide";
  guide.type = multibody::JointType::prismatic;
  guide.bodies = {1, 0};
  guide.point = {0.0, 0.46};
  guide.axis = {0.0, 1.0};
  multibody::Driver level;
  level.name = "level";
  level.body = 1;
  level.coordinate = 2;
  multibody::Spring spring;
  spring.name = "spring";
  spring.bodies = {1, 0};
  spring.from = {0.0, 1.5};
  spring.to = {0.0, 0.46};
  spring.stiffness = 1e6;
  spring.damping = 2e4;
  spring.preload = -9000.0 * 9.81;
  vehicle.mechanism.name = vehicle.name;
  vehicle.mechanism.bodies = {wheel, body};
  vehicle.mechanism.joints = {guide};
  vehicle.mechanism.drivers = {level};
  vehicle.mechanism.springs = {spring};
  train::Wheel contact;
  contact.name = "wheel";
  contact.radius = 0.46;
  contact.law.stiffness = 8.6e10;
  vehicle.wheels = {contact};
  return vehicle;
}

/// A train on its way. System gives the equilibrium that it starts from.
class Ride {
 public:
  Ride(int coaches, double step) : step_(step) {
    const int number = std::max(coaches, 1);
    const scene::Scene scene = scene::read_scene(options::Options({
        {"beam_spans", "32.0*" + std::to_string(spans)},
        {"beam_elements_per_span", "10"},
        {"beam_EI", "3.795e11"},
        {"beam_mass", "3.0e4"},
        {"beam_continuity", "simply_supported"},
        {"support_types", "roller"},
        {"vehicle_coach_file", traverse::source_folder() + "/options/vehicles/s300.yml"},
        {"train_vehicles", "coach*" + std::to_string(number)},
        {"train_positions", std::to_string(16.0 + 25.0 * (number - 1))},
        {"train_spacing", "25.0"},
        {"train_speed", std::to_string(speed)},
        {"ts_max_time", "1.0"},
    }));
    beam_ = std::make_unique<beam::Beam>(PETSC_COMM_WORLD, *scene.beam);
    beam_->set_rayleigh({0.5, 5e-4});
    coupling::SystemInput input{scene.vehicles, scene.train, scene.load, scene.profile, scene.gravity, false};
    if (coaches == 0) {
      input.types = {quarter_car()};
      input.types[0].mechanism.gravity = scene.gravity;
    }
    system_ = std::make_unique<coupling::System>(PETSC_COMM_WORLD, beam_.get(), std::move(input));
    operator_ = std::make_unique<structure::BeamOperator>(*beam_);
    compliance_ = std::make_unique<structure::Compliance>(*beam_, *operator_);
    begin();
  }

  void begin() {
    std::vector<double> y(static_cast<std::size_t>(system_->local_size()));
    system_->start(true, y.data());
    fleet_ = system_->fleet();
    const std::size_t n = static_cast<std::size_t>(system_->structure_unknowns());
    const auto f = static_cast<std::size_t>(fleet_.freedom());
    const auto part = [&](std::size_t from, std::size_t size) {
      const auto begin = y.begin() + static_cast<std::ptrdiff_t>(from);
      return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(size));
    };
    beam_motion_ = {part(0, n), part(n, n), std::vector<double>(n, 0.0)};
    train_motion_ = {part(2 * n, f), part(2 * n + f, f), std::vector<double>(f, 0.0)};
    z_.resize(n);
    for (std::vector<double>* v : {&x_, &p_, &pd_}) v->resize(f);
    t_ = 0.0;
    front_ = fleet_.coordinates(fleet_.wheels[0]).x();
  }

  bool at_end() const { return front_ + speed * (t_ + step_) > 32.0 * spans; }

  /// One step; false when it cannot be solved.
  bool advance(double& newton_time, double& stage_time) {
    const double shift = 2.0 / step_;
    t_ += step_;
    predicted(beam_motion_);
    predicted(train_motion_);
    Motion& b = beam_motion_;
    Motion& p = train_motion_;
    operator_->multiply(-1.0, nullptr, b.rate.data(), b.value.data(), z_.data());
    for (std::size_t i = 0; i < z_.size(); ++i)
      if (beam_->fixed()[i] != 0) z_[i] = 0.0;
    operator_->factored(shift, shift * shift).solve(z_.data());
    for (std::size_t i = 0; i < x_.size(); ++i) {
      x_[i] = p.acceleration[i] / (shift * shift);
      p_[i] = p.value[i] + x_[i];
      pd_[i] = p.rate[i] + shift * x_[i];
    }
    const double begin = processor_time();
    if (!fleet_.set(t_, p_.data(), pd_.data())) return false;
    fleet_.place_wheels();
    compliance_->prepare(shift, shift * shift, nullptr, fleet_.elements());
    const double placed = processor_time();
    gather(shift);
    const coupling::StageData stage{t_,   shift, shift * shift,     p.value.data(), p.rate.data(),
                                    &v0_, &w0_,  compliance_.get(), per_node};
    const double ready = processor_time();
    if (!newton_.solve(fleet_, stage, x_.data())) return false;
    const double solved = processor_time();
    newton_time += solved - ready;
    stage_time += solved - ready + placed - begin;
    compliance_->add_response(newton_.element_loads(), z_.data());
    move(beam_motion_, z_);
    move(train_motion_, x_);
    (void)fleet_.accept();
    return true;
  }

 private:
  static constexpr int per_node = 2;
  struct Motion {
    std::vector<double> value, rate, acceleration;
  };

  /// To where it is at the end of the step at zero acceleration.
  void predicted(Motion& m) const {
    for (std::size_t i = 0; i < m.value.size(); ++i) {
      m.value[i] += step_ * m.rate[i] + 0.25 * step_ * step_ * m.acceleration[i];
      m.rate[i] += 0.5 * step_ * m.acceleration[i];
    }
  }
  void move(Motion& m, const std::vector<double>& change) const {
    const double shift = 2.0 / step_;
    for (std::size_t i = 0; i < m.value.size(); ++i) {
      m.value[i] += change[i];
      m.rate[i] += shift * change[i];
      m.acceleration[i] = shift * shift * change[i];
    }
  }
  void gather(double shift) {
    v0_.assign(2 * per_node * std::max<std::size_t>(1, fleet_.elements().size()), 0.0);
    w0_.assign(v0_.size(), 0.0);
    for (std::size_t a = 0; a < fleet_.elements().size(); ++a) {
      const auto unknowns = beam_->running().unknowns(fleet_.elements()[a]);
      for (std::size_t i = 0; i < 2 * per_node; ++i) {
        const auto k = static_cast<std::size_t>(beam_->local(unknowns[i]));
        v0_[2 * per_node * a + i] = beam_motion_.value[k] + z_[k];
        w0_[2 * per_node * a + i] = beam_motion_.rate[k] + shift * z_[k];
      }
    }
  }

  double step_, t_ = 0.0, front_ = 0.0;
  std::unique_ptr<beam::Beam> beam_;
  std::unique_ptr<coupling::System> system_;
  std::unique_ptr<structure::BeamOperator> operator_;
  std::unique_ptr<structure::Compliance> compliance_;
  train::Fleet fleet_;
  coupling::ContactNewton newton_;
  Motion beam_motion_, train_motion_;
  std::vector<double> v0_, w0_;
  std::vector<double> z_, x_, p_, pd_;  // beam's response; the train's change, p, p'
};

void ride(benchmark::State& state, int coaches, double step) {
  Ride ride(coaches, step);
  const double reading = clock_cost();
  double newton = 0.0, stage = 0.0;
  for (auto _ : state) {
    if (ride.at_end()) ride.begin();
    if (!ride.advance(newton, stage)) {
      state.SkipWithError("a stage has no solution");
      break;
    }
  }
  const double number = std::max(coaches, 1) * static_cast<double>(state.iterations());
  state.counters["newton"] = newton / number - reading / std::max(coaches, 1);
  state.counters["stage"] = stage / number - 2.0 * reading / std::max(coaches, 1);
}

void train(benchmark::State& state) {
  ride(state, static_cast<int>(state.range(0)), 1e-3 * static_cast<double>(state.range(1)));
}
void quarter_car(benchmark::State& state) { ride(state, 0, 1e-3 * static_cast<double>(state.range(0))); }

BENCHMARK(train)->ArgsProduct({{1, 4, 16}, {5, 10, 20}})->Iterations(2000);
BENCHMARK(quarter_car)->Arg(5)->Arg(20)->Iterations(20000);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  int count = 1;
  (void)SlepcInitialize(&count, &argv, nullptr, nullptr);
  benchmark::RunSpecifiedBenchmarks();
  (void)SlepcFinalize();
  return 0;
}
