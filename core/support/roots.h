#pragma once

#include <functional>
#include <utility>

namespace imunoise {

/// The x in [low, high] at which f is zero, by Newton's method, which falls back on halves where it
/// would leave the bracket. `f` gives its value and its slope; its values at low and high differ in
/// sign; `guess` lies between them. To about 1e-15 of high where f is smooth.
double root_by_newton(const std::function<std::pair<double, double>(double)>& f, double guess,
                      double low, double high);

/// The same without slopes, by the method of Alefeld, Potra and Shi (1995, ACM TOMS 748).
double root_between(const std::function<double(double)>& f, double low, double high);

}  // namespace imunoise
