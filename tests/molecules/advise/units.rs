//! Units.

use kickdrift::advise::unit::Dimension::{Rate, Stiffness, Time, Wavenumber};
use kickdrift::advise::unit::{measured, period_of_wavenumber, rational};
use kickdrift::number::Laurent;

use kickdrift::number::rational::ratio;

#[test]
fn every_unit_is_what_the_si_says() {
    let read = |text: &str, dimension| rational("x", text, dimension).unwrap();
    assert_eq!(read("1 s", Time), read("1e15fs", Time));
    assert_eq!(read("1 ns", Time), read("1000 ps", Time));
    // The gas constant in two units: 1 eV is 96485.33212... J/mol, the Faraday constant's number.
    let faraday = read("1 eV/A^2", Stiffness) / read("1 kJ/mol/nm^2", Stiffness);
    assert_eq!(faraday, ratio(964_853_321_233_100_184, 100_000_000_000_000));
    assert_eq!(read("1 kcal/mol/Å²", Stiffness) / read("1kJ/mol/nm^2", Stiffness), ratio(4184, 10));
    // 1 eV/Å² = 16.02176634 N/m.
    assert_eq!(read("1 eV/A^2", Stiffness) / read("1 N/m", Stiffness), ratio(1_602_176_634, 100_000_000));
    assert_eq!(read("5/ps", Rate), ratio(5, 1000));
}

#[test]
fn a_wavenumber_is_read_in_each_of_its_notations() {
    for text in ["3700/cm", "3700 1/cm", "3700cm^-1", "3700 cm-1", "3700 cm⁻¹"] {
        assert_eq!(rational("x", text, Wavenumber).unwrap(), ratio(3700, 1), "{text}");
    }
    assert_eq!(rational("x", "37001/cm", Wavenumber).unwrap(), ratio(37001, 1));
    let period = period_of_wavenumber(&Laurent::from_integer(3700)).unwrap();
    assert!((period.to_f64() - 9.015_25).abs() < 1e-5);
}

#[test]
fn what_has_no_unit_is_told_how_to_get_one() {
    for (text, word) in [
        ("10", "10fs"),
        ("ten", "10fs"),
        ("10 m", "10fs"),
        ("10ps/cm", "fs"),
        ("-1fs", "positive"),
        ("fs", "10fs"),
    ] {
        let message = measured("period", text, Time).unwrap_err().to_string();
        assert!(message.starts_with(&format!("period = {text}: ")) && message.contains(word), "{message}");
    }
    assert!(rational("step", "pi fs", Time).unwrap_err().remedy().contains("without pi"));
}
