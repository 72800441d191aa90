//! Axes: from data to the unit interval, and ticks at round numbers.

/// How values spread along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps for equal differences.
    Linear,
    /// Equal steps for equal ratios.
    Log,
}

/// One axis: its label, its range, its scale.
///
/// Labels use the notation `*h*_1` for an italic h with index 1.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Axis {
    pub(crate) label: String,
    pub(crate) lo: f64,
    pub(crate) hi: f64,
    pub(crate) scale: Scale,
    pub(crate) chosen: Option<Vec<Tick>>,
    /// The power of time that its values have.
    time: i8,
}

/// A mark on an axis; a minor one has no label.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Where, in data units.
    pub at: f64,
    /// The label beside it.
    pub label: Option<String>,
}

impl Axis {
    /// A linear axis over `[lo, hi]`. A range that is empty or not finite is widened until something can be
    /// drawn.
    pub fn linear(label: &str, lo: f64, hi: f64) -> Self {
        // Beyond this the length of the range would overflow.
        let (lo, hi) = (if lo.is_finite() { lo.max(-1e307) } else { 0.0 }, hi.min(1e307));
        let narrow = !hi.is_finite() || hi - lo <= f64::EPSILON * (lo.abs() + hi.abs());
        let hi = if narrow { lo + lo.abs().max(1.0) / 2.0 } else { hi };
        Self::new(label, lo, hi, Scale::Linear)
    }

    /// A logarithmic axis over `[lo, hi]`, both positive. What is not is replaced, so that something can be
    /// drawn.
    pub fn log(label: &str, lo: f64, hi: f64) -> Self {
        let hi = if hi.is_finite() && hi > f64::MIN_POSITIVE { hi } else { 1.0 };
        let lo = if lo > 0.0 && lo < hi / 1.001 { lo } else { hi / 10.0 };
        Self::new(label, lo, hi, Scale::Log)
    }

    fn new(label: &str, lo: f64, hi: f64, scale: Scale) -> Self {
        Axis { label: label.into(), lo, hi, scale, chosen: None, time: 0 }
    }

    /// Puts it in units of time, which its label names.
    pub fn of_time(self) -> Self {
        Axis { time: 1, ..self }
    }

    /// Puts it in inverse units of time, which its label names.
    pub fn per_time(self) -> Self {
        Axis { time: -1, ..self }
    }

    pub(crate) fn has_time(&self) -> bool {
        self.time != 0
    }

    /// Writes the unit into its label.
    pub(crate) fn in_units_of(&self, unit: &str) -> Self {
        let label = match self.time {
            0 => self.label.clone(),
            1 => format!("{} ({unit})", self.label),
            _ => format!("{} (1/{unit})", self.label),
        };
        Axis { label, ..self.clone() }
    }

    /// Replaces its ticks: by names, or by points that matter.
    pub fn ticks(mut self, ticks: Vec<Tick>) -> Self {
        self.chosen = Some(ticks);
        self
    }

    /// Where a value lies: 0 at the lower end, 1 at the upper, beyond outside; NaN where it lies nowhere.
    pub fn unit(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => (value - self.lo) / (self.hi - self.lo),
            // Differences of logarithms: a quotient could overflow.
            Scale::Log if value > 0.0 => {
                (value.log10() - self.lo.log10()) / (self.hi.log10() - self.lo.log10())
            }
            Scale::Log => f64::NAN,
        }
    }

    /// Ticks with at most `most` of them labelled (at least two are allowed).
    pub(crate) fn marks(&self, most: usize) -> Vec<Tick> {
        let most = most.max(2);
        let all = match (&self.chosen, self.scale) {
            (Some(chosen), _) => chosen.clone(),
            (None, Scale::Linear) => linear_ticks(self.lo, self.hi, most),
            (None, Scale::Log) => log_ticks(self.lo, self.hi, most),
        };
        // A hair of slack: an end such as 0.3 = 3 x 0.1 in doubles belongs to its tick.
        all.into_iter().filter(|tick| (-1e-9..=1.0 + 1e-9).contains(&self.unit(tick.at))).collect()
    }
}

/// A step of 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy)]
struct Step {
    digit: i64,
    power: i32,
}

impl Step {
    /// The smallest one that makes at most `most` ticks over `length`.
    fn over(length: f64, most: usize) -> Step {
        let wanted = length / most as f64;
        let mut power = wanted.log10().floor() as i32 - 1;
        loop {
            for digit in [1, 2, 5] {
                let step = Step { digit, power };
                if step.times(1) >= wanted {
                    return step;
                }
            }
            power += 1;
        }
    }

    /// `count` steps, correctly rounded for every power that a double of 22 digits can hold.
    fn times(self, count: i64) -> f64 {
        let whole = (count * self.digit) as f64;
        if self.power < 0 { whole / 10f64.powi(-self.power) } else { whole * 10f64.powi(self.power) }
    }

    /// Into how many parts minor ticks divide it: round numbers again.
    fn parts(self) -> i64 {
        if self.digit == 2 { 4 } else { 5 }
    }

    /// `count` steps in writing, exactly.
    fn written(self, count: i64, largest: f64) -> String {
        let whole = count * self.digit;
        if whole == 0 {
            return "0".into();
        }
        if !(1e-4..1e6).contains(&largest) {
            return power_of_ten(whole, self.power);
        }
        let sign = if whole < 0 { "−" } else { "" };
        let digits = whole.unsigned_abs().to_string();
        if self.power >= 0 {
            return format!("{sign}{digits}{}", "0".repeat(self.power as usize));
        }
        let places = self.power.unsigned_abs() as usize;
        let padded = format!("{digits:0>width$}", width = places + 1);
        let (whole, part) = padded.split_at(padded.len() - places);
        format!("{sign}{whole}.{part}")
    }
}

/// `whole x 10^power` as a short mantissa and a power, in the notation of labels.
fn power_of_ten(whole: i64, power: i32) -> String {
    let sign = if whole < 0 { "−" } else { "" };
    let digits = whole.unsigned_abs().to_string();
    let exponent = power + digits.len() as i32 - 1;
    let (first, rest) = digits.split_at(1);
    let rest = rest.trim_end_matches('0');
    let point = if rest.is_empty() { "" } else { "." };
    let exponent = exponent.to_string().replace('-', "−");
    match format!("{first}{point}{rest}").as_str() {
        "1" => format!("{sign}10^{{{exponent}}}"),
        mantissa => format!("{sign}{mantissa}×10^{{{exponent}}}"),
    }
}

fn linear_ticks(lo: f64, hi: f64, most: usize) -> Vec<Tick> {
    let step = Step::over(hi - lo, most);
    let largest = lo.abs().max(hi.abs());
    let parts = step.parts();
    let (first, last) = ((lo / step.times(1)).floor() as i64, (hi / step.times(1)).ceil() as i64);
    let mut ticks = Vec::new();
    for count in first..=last.min(first.saturating_add(most as i64 + 2)) {
        let at = step.times(count);
        ticks.push(Tick { at, label: Some(step.written(count, largest)) });
        let minor = |part: i64| at + step.times(1) * part as f64 / parts as f64;
        ticks.extend((1..parts).map(|part| Tick { at: minor(part), label: None }));
    }
    ticks
}

fn log_ticks(lo: f64, hi: f64, most: usize) -> Vec<Tick> {
    let decades = hi.log10() - lo.log10();
    if decades < 1.0 {
        return linear_ticks(lo, hi, most);
    }
    let (first, last) = (lo.log10().floor() as i32, hi.log10().ceil() as i32);
    let every = (decades / most as f64).ceil().max(1.0) as i32;
    let mut ticks = Vec::new();
    for power in first..=last {
        let label = (power.rem_euclid(every) == 0).then(|| match power {
            0 => "1".into(),
            1 => "10".into(),
            _ => power_of_ten(1, power),
        });
        let at = Step { digit: 1, power }.times(1);
        ticks.push(Tick { at, label });
        if every == 1 {
            ticks.extend((2..10).map(|digit| Tick { at: Step { digit, power }.times(1), label: None }));
        }
    }
    ticks
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, most: usize) -> Vec<String> {
        axis.marks(most).into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round_numbers_in_the_range() {
        let axis = Axis::linear("", 0.0, 2.0 / std::f64::consts::PI);
        assert_eq!(labels(&axis, 7), ["0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6"]);
        assert_eq!(labels(&axis, 4), ["0", "0.2", "0.4", "0.6"]);
        assert_eq!(labels(&Axis::linear("", -1.0, 1.0), 5), ["−1.0", "−0.5", "0", "0.5", "1.0"]);
        assert_eq!(labels(&Axis::linear("", 0.0, 3e-7), 4), ["0", "10^{−7}", "2×10^{−7}", "3×10^{−7}"]);
        assert_eq!(labels(&Axis::linear("", 0.0, 2.5e7), 3), ["0", "10^{7}", "2×10^{7}"]);
        assert_eq!(labels(&Axis::linear("", 0.7316, 0.73162), 3), ["0.73160", "0.73161", "0.73162"]);
    }

    #[test]
    fn values_are_the_doubles_nearest_to_their_labels() {
        for tick in Axis::linear("", 0.0, 1.0).marks(10) {
            if let Some(label) = tick.label {
                assert_eq!(tick.at, label.parse::<f64>().unwrap());
            }
        }
    }

    #[test]
    fn minor_ticks_divide_the_step_into_round_parts() {
        let minor =
            Axis::linear("", 0.0, 1.0).marks(5).into_iter().filter(|tick| tick.label.is_none()).count();
        assert_eq!(minor, 5 * 3);
    }

    #[test]
    fn decades_are_labelled_and_thinned_out() {
        assert_eq!(labels(&Axis::log("", 1e-2, 1e2), 8), ["10^{−2}", "10^{−1}", "1", "10", "10^{2}"]);
        assert_eq!(
            labels(&Axis::log("", 1e-300, 1e300), 4),
            ["10^{−300}", "10^{−150}", "1", "10^{150}", "10^{300}"]
        );
        assert_eq!(labels(&Axis::log("", 2.0, 5.0), 4), ["2", "3", "4", "5"]);
        let axis = Axis::log("", 1.0, 100.0);
        assert!((axis.unit(10.0) - 0.5).abs() < 1e-15 && axis.unit(-1.0).is_nan());
    }

    #[test]
    fn impossible_ranges_still_give_an_axis() {
        let one = f64::from_bits(1.0f64.to_bits() + 1);
        for (lo, hi) in
            [(1.0, 1.0), (1.0, one), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (-1e300, 1e300)]
        {
            let axis = Axis::linear("", lo, hi);
            assert!(axis.lo < axis.hi, "{lo} {hi}");
            assert!(axis.marks(6).len() < 100);
            let axis = Axis::log("", lo, hi);
            assert!(0.0 < axis.lo && axis.lo < axis.hi, "{lo} {hi}");
            assert!(axis.marks(6).len() < 100);
        }
    }
}
