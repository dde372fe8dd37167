//! Moments as text, in UTC.

use std::time::{SystemTime, UNIX_EPOCH};

/// Seconds since 1970.
pub fn now_s() -> f64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64())
}

/// The time in the form of `2026-02-03T04:05:06Z`.
pub fn iso(seconds: f64) -> String {
    let t = Civil::of(seconds);
    format!("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", t.year, t.month, t.day, t.hour, t.minute, t.second)
}

/// The time as C's `ctime` writes it, without the line's end: `Tue Feb  3 04:05:06 2026`.
pub fn ctime(seconds: f64) -> String {
    const DAYS: [&str; 7] = ["Thu", "Fri", "Sat", "Sun", "Mon", "Tue", "Wed"];
    const MONTHS: [&str; 12] = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];
    let t = Civil::of(seconds);
    let (weekday, month) = (DAYS[t.days.rem_euclid(7) as usize], MONTHS[t.month as usize - 1]);
    format!("{weekday} {month} {:2} {:02}:{:02}:{:02} {}", t.day, t.hour, t.minute, t.second, t.year)
}

/// A moment by the calendar.
struct Civil {
    /// Since 1 January 1970, a Thursday.
    days: i64,
    year: i64,
    month: i64,
    day: i64,
    hour: i64,
    minute: i64,
    second: i64,
}

impl Civil {
    /// Hinnant, "chrono-Compatible Low-Level Date Algorithms", `civil_from_days`.
    fn of(seconds: f64) -> Self {
        let seconds = seconds.floor() as i64;
        let (days, rest) = (seconds.div_euclid(86400), seconds.rem_euclid(86400));
        let z = days + 719_468;
        let era = z.div_euclid(146_097);
        let day_of_era = z.rem_euclid(146_097);
        let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
        let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
        let from_march = (5 * day_of_year + 2) / 153;
        let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
        Self {
            days,
            year: year_of_era + era * 400 + i64::from(month <= 2),
            month,
            day: day_of_year - (153 * from_march + 2) / 5 + 1,
            hour: rest / 3600,
            minute: rest / 60 % 60,
            second: rest % 60,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_moments() {
        assert_eq!((iso(0.0), ctime(0.0)), ("1970-01-01T00:00:00Z".into(), "Thu Jan  1 00:00:00 1970".into()));
        assert_eq!((iso(951_827_696.9), ctime(951_827_696.9)), ("2000-02-29T12:34:56Z".into(), "Tue Feb 29 12:34:56 2000".into()));
        assert_eq!(ctime(1_770_091_506.0), "Tue Feb  3 04:05:06 2026");
    }
}
