#include "services/logger/log_name.h"

#include <cstdio>

namespace visavis {
namespace {

struct Date {
  long long year, month, day;
};

/// Gregorian date of a day counted from 1970-01-01, for days >= 0 (H. Hinnant, chrono-Compatible
/// Low-Level Date Algorithms: years begin in March, so that the leap day is the last).
Date DateOfDay(long long day) {
  day += 719'468;                                               // from 0000-03-01
  const long long era = day / 146'097, of_era = day % 146'097;  // 400 years
  const long long year_of_era =
      (of_era - of_era / 1'460 + of_era / 36'524 - of_era / 146'096) / 365;
  const long long of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const long long march_month = (5 * of_year + 2) / 153;
  const long long month = march_month < 10 ? march_month + 3 : march_month - 9;
  return {year_of_era + 400 * era + (month <= 2 ? 1 : 0), month,
          of_year - (153 * march_month + 2) / 5 + 1};
}

}  // namespace

std::string LogName(const std::string& name, std::int64_t utime_us, int copy) {
  const long long seconds = utime_us / 1'000'000, of_day = seconds % 86'400;
  const Date date = DateOfDay(seconds / 86'400);
  char time[96];
  std::snprintf(time, sizeof time, "%04lld%02lld%02lldT%02lld%02lld%02lldZ", date.year, date.month,
                date.day, of_day / 3600, of_day / 60 % 60, of_day % 60);
  std::string result = name + "-" + time;
  if (copy > 0) result += "-" + std::to_string(copy);
  return result + ".lcm";
}

}  // namespace visavis
