//! Published integrators as words.

use super::letters::Word;
use number::error::{Error, Result};

/// A published integrator.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// The name by which it is asked for.
    pub name: &'static str,
    /// The order that its source states, on any problem: on oscillators it may be higher.
    pub order: u64,
    /// The word; decimals are those of the source.
    pub text: &'static str,
    /// Where the coefficients come from.
    pub source: &'static str,
    /// Programs that have it, each with what to write there, as "LAMMPS: run_style respa".
    pub engines: &'static [&'static str],
}

impl Method {
    /// Its word.
    pub fn word(&self) -> Word {
        self.text.parse().expect("the words of the catalogue are words: a test reads them all")
    }
}

/// The method of a name.
///
/// # Errors
/// A name that is not in the catalogue.
pub fn method(name: &str) -> Result<&'static Method> {
    let found = METHODS.iter().find(|method| method.name == name);
    found.ok_or_else(|| Error::unknown("method", name, METHODS.iter().map(|method| method.name)))
}

macro_rules! methods {
    ($($name:literal $order:literal $text:expr, $source:expr $(, $engine:literal)*;)*) => {
        &[$(Method { name: $name, order: $order, text: $text, source: $source, engines: &[$($engine),*] }),*]
    };
}

/// Verlet steps of these shares, the outer half of them; the middle one makes the sum 1.
macro_rules! verlets {
    ($first:literal $($share:literal)*; $middle:literal) => {
        verlets!(@ [concat!("K((", $first, ")/2) D(", $first, ") K((", $first, ")/2) ")] [""] $first; $($share)*; $middle)
    };
    (@ [$before:expr] [$after:expr] $last:literal; $next:literal $($share:literal)*; $middle:literal) => {
        verlets!(@
            [concat!($before, "K((", $next, ")/2) D(", $next, ") K((", $next, ")/2) ")]
            [concat!(" K((", $last, ")/2) D(", $last, ") K((", $last, ")/2)", $after)]
            $next; $($share)*; $middle)
    };
    (@ [$before:expr] [$after:expr] $last:literal; ; $middle:literal) => {
        concat!($before, "K((", $middle, ")/2) D(", $middle, ") K((", $middle, ")/2)",
            " K((", $last, ")/2) D(", $last, ") K((", $last, ")/2)", $after)
    };
}

const MCLACHLAN_ATELA: &str = "McLachlan, Atela, Nonlinearity 5, 541 (1992)";
const OMELYAN_2002: &str = "Omelyan, Mryglod, Folk, Comput. Phys. Commun. 146, 188 (2002)";
const OMELYAN_2003: &str = "Omelyan, Mryglod, Folk, Comput. Phys. Commun. 151, 272 (2003)";
const BCSS: &str = "Blanes, Casas, Sanz-Serna, SIAM J. Sci. Comput. 36, A1556 (2014)";
const BLANES_MOAN: &str = "Blanes, Moan, J. Comput. Appl. Math. 142, 313 (2002)";
const YOSHIDA: &str = "Yoshida, Phys. Lett. A 150, 262 (1990)";
const CHIN: &str = "Chin, Phys. Lett. A 226, 344 (1997)";
const BAOAB_RESPA: &str = "Lagardere, Aviat, Piquemal, J. Phys. Chem. Lett. 10, 2593 (2019)";
const IPI: &str = "Kapil et al., Comput. Phys. Commun. 236, 214 (2019)";
const MOLLY: &str = "Garcia-Archilla, Sanz-Serna, Skeel, SIAM J. Sci. Comput. 20, 930 (1998)";
const RESPA: &str = "Tuckerman, Berne, Martyna, J. Chem. Phys. 97, 1990 (1992)";

/// All of them, simple ones first; the last ones are of two forces, K1 the fast one.
pub const METHODS: &[Method] = methods! {
    "symplectic-euler" 1 "K(1) D(1)", "Hairer, Lubich, Wanner, Geometric Numerical Integration, I.1.2";
    "velocity-verlet" 2 "K(1/2) D(1) K(1/2)", "Swope, Andersen, Berens, Wilson, J. Chem. Phys. 76, 637 (1982)",
        "LAMMPS: run_style verlet", "GROMACS: integrator = md-vv", "ASE: VelocityVerlet";
    "position-verlet" 2 "D(1/2) K(1) D(1/2)", RESPA;
    "midpoint" 2 "C(1)", "Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.4";
    // beta = 1/4, gamma = 1/2: the trapezoidal rule, on linear problems the midpoint rule.
    "newmark" 2 "C(1)", "Newmark, J. Eng. Mech. Div. ASCE 85, 67 (1959)";
    "mclachlan-atela-2" 2 "K(1-1/sqrt(2)) D(1/sqrt(2)) K(1/sqrt(2)) D(1-1/sqrt(2))", MCLACHLAN_ATELA;
    "2mn-velocity" 2 "K(0.1931833275037836) D(1/2) K(1-2*0.1931833275037836) D(1/2) K(0.1931833275037836)", OMELYAN_2002,
        "tmLQCD: Type = 2MN";
    "2mn-position" 2 "D(0.1931833275037836) K(1/2) D(1-2*0.1931833275037836) K(1/2) D(0.1931833275037836)", OMELYAN_2002;
    "bcss-2" 2 "K((3-sqrt(3))/6) D(1/2) K(sqrt(3)/3) D(1/2) K((3-sqrt(3))/6)", BCSS;
    // The condition 6 a b - 2 a - b + 1/2 = 0, under which a zero of A and one of D coincide, gives b from a.
    "bcss-3" 2
        "K((1/2-2*0.29619504261126)/(1-6*0.29619504261126)) D(0.29619504261126) K(1/2-(1/2-2*0.29619504261126)/(1-6*0.29619504261126)) D(1-2*0.29619504261126) K(1/2-(1/2-2*0.29619504261126)/(1-6*0.29619504261126)) D(0.29619504261126) K((1/2-2*0.29619504261126)/(1-6*0.29619504261126))",
        BCSS;
    "bcss-3-decimals" 2
        "K(0.11888010966548) D(0.29619504261126) K(1/2-0.11888010966548) D(1-2*0.29619504261126) K(1/2-0.11888010966548) D(0.29619504261126) K(0.11888010966548)",
        BCSS;
    "bcss-4" 2
        "K(0.071353913450279725904) D(0.1916678) K(0.268548791161230105820) D(1/2-0.1916678) K(1-2*(0.071353913450279725904+0.268548791161230105820)) D(1/2-0.1916678) K(0.268548791161230105820) D(0.1916678) K(0.071353913450279725904)",
        BCSS;
    "forest-ruth" 4 verlets!("1/(2-2^(1/3))"; "-2^(1/3)/(2-2^(1/3))"), "Forest, Ruth, Physica D 43, 105 (1990); Yoshida, Phys. Lett. A 150, 262 (1990)";
    "suzuki-4" 4 verlets!("1/(4-4^(1/3))" "1/(4-4^(1/3))"; "1-4/(4-4^(1/3))"), "Suzuki, Phys. Lett. A 146, 319 (1990)";
    "mclachlan-atela-4" 4
        "K(0.1344961992774310892) D(0.5153528374311229364) K(-0.2248198030794208058) D(-0.085782019412973646) K(0.7563200005156682911) D(0.4415830236164665242) K(0.3340036032863214255) D(0.1288461583653841854)",
        MCLACHLAN_ATELA;
    "pefrl" 4
        "D(0.1786178958448091) K((1-2*(-0.2123418310626054))/2) D(-0.06626458266981849) K(-0.2123418310626054) D(1-2*(0.1786178958448091-0.06626458266981849)) K(-0.2123418310626054) D(-0.06626458266981849) K((1-2*(-0.2123418310626054))/2) D(0.1786178958448091)",
        OMELYAN_2002;
    // The word of PEFRL, its last digits rounded otherwise.
    "4mn4fp" 4
        "D(0.1786178958448091) K(0.7123418310626056) D(-0.06626458266981843) K(1/2-0.7123418310626056) D(1-2*(0.1786178958448091-0.06626458266981843)) K(1/2-0.7123418310626056) D(-0.06626458266981843) K(0.7123418310626056) D(0.1786178958448091)",
        OMELYAN_2003;
    "vefrl" 4
        "K(0.1644986515575760) D((1-2*(-0.02094333910398989))/2) K(1.235692651138917) D(-0.02094333910398989) K(1-2*(0.1644986515575760+1.235692651138917)) D(-0.02094333910398989) K(1.235692651138917) D((1-2*(-0.02094333910398989))/2) K(0.1644986515575760)",
        OMELYAN_2002;
    "4mn5fv" 4
        "K(0.08398315262876693) D(0.2539785108410595) K(0.6822365335719091) D(-0.03230286765269967) K(1/2-0.08398315262876693-0.6822365335719091) D(1-2*(0.2539785108410595-0.03230286765269967)) K(1/2-0.08398315262876693-0.6822365335719091) D(-0.03230286765269967) K(0.6822365335719091) D(0.2539785108410595) K(0.08398315262876693)",
        OMELYAN_2003;
    "4mn5fp" 4
        "D(0.2750081212332419) K(-0.0844296195070715) D(-0.1347950099106792) K(0.354900057157426) D(1/2-0.2750081212332419+0.1347950099106792) K(1-2*(0.354900057157426-0.0844296195070715)) D(1/2-0.2750081212332419+0.1347950099106792) K(0.354900057157426) D(-0.1347950099106792) K(-0.0844296195070715) D(0.2750081212332419)",
        OMELYAN_2003;
    "blanes-moan-4" 4
        "K(0.0792036964311957) D(0.209515106613362) K(0.353172906049774) D(-0.143851773179818) K(-0.0420650803577195) D(1/2-0.209515106613362+0.143851773179818) K(1-2*(0.0792036964311957+0.353172906049774-0.0420650803577195)) D(1/2-0.209515106613362+0.143851773179818) K(-0.0420650803577195) D(-0.143851773179818) K(0.353172906049774) D(0.209515106613362) K(0.0792036964311957)",
        BLANES_MOAN;
    "blanes-moan-rkn-4" 4
        "K(0.0829844064174052) D(0.245298957184271) K(0.396309801498368) D(0.604872665711080) K(-0.0390563049223486) D(1/2-0.245298957184271-0.604872665711080) K(1-2*(0.0829844064174052+0.396309801498368-0.0390563049223486)) D(1/2-0.245298957184271-0.604872665711080) K(-0.0390563049223486) D(0.604872665711080) K(0.396309801498368) D(0.245298957184271) K(0.0829844064174052)",
        BLANES_MOAN;
    "chin-4a" 4 "K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)", CHIN;
    "chin-4c" 4 "D(1/6) K(3/8) D(1/3) K(1/4, -1/96) D(1/3) K(3/8) D(1/6)", CHIN;
    "yoshida-6" 6
        verlets!("0.78451361047755726382" "0.23557321335935813368" "-1.17767998417887100695"; "1-2*(0.78451361047755726382+0.23557321335935813368-1.17767998417887100695)"),
        YOSHIDA;
    "kahan-li-6" 6
        verlets!("0.39216144400731413928" "0.33259913678935943860" "-0.70624617255763935981" "0.08221359629355080023"; "1-2*(0.39216144400731413928+0.33259913678935943860-0.70624617255763935981+0.08221359629355080023)"),
        "Kahan, Li, Math. Comput. 66, 1089 (1997)";
    "yoshida-8" 8
        verlets!("1.04242620869991" "1.82020630970714" "0.157739928123617" "2.44002732616735" "-0.00716989419708120" "-2.44699182370524" "-1.61582374150097"; "1-2*(1.04242620869991+1.82020630970714+0.157739928123617+2.44002732616735-0.00716989419708120-2.44699182370524-1.61582374150097)"),
        YOSHIDA;
    "baoab" 2 "K(1/2) D(1/2) O(1) D(1/2) K(1/2)", "Leimkuhler, Matthews, Appl. Math. Res. Express 2013, 34 (2013)",
        "ASE: LangevinBAOAB", "OpenMM: LangevinMiddleIntegrator (leapfrog velocities)", "NAMD: langevinBAOAB = on", "i-PI: splitting = baoab";
    "obabo" 2 "O(1/2) K(1/2) D(1) K(1/2) O(1/2)", "Bussi, Parrinello, Phys. Rev. E 75, 056707 (2007)", "i-PI: splitting = obabo";
    "respa-4" 2 "K2(1/2) 4*(K1(1/8) D(1/4) K1(1/8)) K2(1/2)", RESPA,
        "OpenMM: MTSIntegrator", "LAMMPS: run_style respa", "GROMACS: mts = yes", "NAMD: nonbondedFreq, fullElectFrequency",
        "Tinker: integrator respa", "i-PI: nmts";
    "mts-baoab-4" 2 "K2(1/2) 4*(K1(1/8) D(1/8) O(1/4) D(1/8) K1(1/8)) K2(1/2)", BAOAB_RESPA, "OpenMM: MTSLangevinIntegrator";
    "mts-baoab-middle-4" 2 "K2(1/2) 2*(K1(1/8) D(1/4) K1(1/8)) O(1) 2*(K1(1/8) D(1/4) K1(1/8)) K2(1/2)", IPI, "i-PI: nmts, splitting = baoab";
    "mts-obabo-4" 2 "O(1/2) K2(1/2) 4*(K1(1/8) D(1/4) K1(1/8)) K2(1/2) O(1/2)", IPI, "i-PI: nmts, splitting = obabo";
    "avi-3-2" 2
        "K1(1/6) K2(1/4) D(1/3) K1(1/3) D(1/6) K2(1/2) D(1/6) K1(1/3) D(1/3) K2(1/4) K1(1/6)",
        "Lew, Marsden, Ortiz, West, Arch. Ration. Mech. Anal. 167, 85 (2003)";
    "sexton-weingarten-4" 2
        "K2(1/6) 2*(K1(1/24) D(1/8) K1(1/6) D(1/8) K1(1/24)) K2(2/3) 2*(K1(1/24) D(1/8) K1(1/6) D(1/8) K1(1/24)) K2(1/6)",
        "Sexton, Weingarten, Nucl. Phys. B 380, 665 (1992)";
    "implicit-explicit" 2 "K2(1/2) C1(1) K2(1/2)", "Stern, Grinspun, Multiscale Model. Simul. 7, 1779 (2009)";
    "impulse" 2 "K2(1/2) R1(1) K2(1/2)", RESPA;
    "deuflhard" 2 "K2(1/2) R1(1) K2(1/2)", "Deuflhard, Z. Angew. Math. Phys. 30, 177 (1979)";
    "gautschi" 2 "K2[sinc(x/2)/cos(x/2)](1/2) R1(1) K2[sinc(x/2)/cos(x/2)](1/2)", "Gautschi, Numer. Math. 3, 381 (1961)";
    "molly-short" 2 "K2[sinc(x/2)^2](1/2) R1(1) K2[sinc(x/2)^2](1/2)", MOLLY;
    "molly-linear" 2 "K2[sinc(x/2)^4](1/2) R1(1) K2[sinc(x/2)^4](1/2)", MOLLY;
    "molly-long" 2 "K2[sinc(x)^2](1/2) R1(1) K2[sinc(x)^2](1/2)", MOLLY;
    // Of the slow force a mode with a fast one feels nothing: no order on such an oscillator.
    "molly-equilibrium" 0 "K2[0](1/2) R1(1) K2[0](1/2)", "Izaguirre, Reich, Skeel, J. Chem. Phys. 110, 9853 (1999)",
        "LAMMPS: fix filter/corotate", "NAMD: molly = on";
    "hairer-lubich" 2 "K2[sinc(x)](1/2) R1(1) K2[sinc(x)](1/2)", "Hairer, Lubich, SIAM J. Numer. Anal. 38, 414 (2000)";
    "grimm-hochbruck" 2 "K2[sinc(x)^3](1/2) R1(1) K2[sinc(x)^3](1/2)", "Grimm, Hochbruck, J. Phys. A 39, 5495 (2006)";
    "rpmd" 2 "K2(1/2) R1(1) K2(1/2)", "Ceriotti, Parrinello, Markland, Manolopoulos, J. Chem. Phys. 133, 124104 (2010)",
        "i-PI: normal_modes propagator = exact";
    "rpmd-cayley" 2 "K2(1/2) C1(1) K2(1/2)", "Korol, Bou-Rabee, Miller, J. Chem. Phys. 151, 124103 (2019)",
        "i-PI: normal_modes propagator = cayley";
};
