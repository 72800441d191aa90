//! One portable program, and the vector instructions of the processor that it runs on.

#[cfg(target_arch = "x86_64")]
mod registers;

use std::fmt;
use std::marker::PhantomData;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::{LANES, Vector};
#[cfg(target_arch = "x86_64")]
use registers::{Avx2, Avx2Single, Avx512, Avx512Single};

/// The width of a portable vector that stands for one register. On x86-64 without AVX2 fused operations are
/// calls, and one by one they are no slower.
const PLAIN: usize = if cfg!(target_arch = "x86_64") { 1 } else { 4 };

/// Instructions that this processor has: but for the portable ones nobody has such a value who has not asked
/// the processor, so whatever runs with them may run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Instructions(Set);

/// The instruction sets that kernels are compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Set {
    Portable,
    /// Four doubles at a time, and fused operations.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// Eight doubles at a time.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl fmt::Debug for Instructions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Instructions {
    /// Those that every processor has.
    pub const PORTABLE: Instructions = Instructions(Set::Portable);

    /// Those that this processor has, the best first.
    pub fn available() -> impl Iterator<Item = Instructions> {
        #[cfg(target_arch = "x86_64")]
        let fused = is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
        #[cfg(target_arch = "x86_64")]
        let vector = [
            (
                Set::Avx512,
                fused && is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl"),
            ),
            (Set::Avx2, fused),
        ];
        #[cfg(not(target_arch = "x86_64"))]
        let vector: [(Set, bool); 0] = [];
        let found = vector.into_iter().filter(|(_, has)| *has).map(|(set, _)| Instructions(set));
        found.chain([Instructions::PORTABLE])
    }

    /// The task, compiled for these instructions: the same result to the bit.
    pub fn perform<T: Task>(self, task: T) -> T::Output {
        match self.0 {
            // Safety: `available` alone makes the two, and has seen the features.
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => unsafe { avx512(task) },
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => unsafe { avx2(task) },
            Set::Portable => task.run(),
        }
    }

    /// A task that is done number by number: of all vector instructions it needs the fused operations, which
    /// come with AVX2.
    pub fn perform_alone<T: Task>(self, task: T) -> T::Output {
        match self.0 {
            Set::Portable => task.run(),
            // Safety: who has AVX-512 has the others too, as `available` has seen.
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 | Set::Avx512 => unsafe { avx2(task) },
        }
    }

    /// The kernel, with the vectors that these instructions have: the same result to the bit.
    pub fn compute<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            // Safety: as above.
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => unsafe { avx512(With::<Avx512, K>(kernel, PhantomData)) },
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => unsafe { avx2(With::<Avx2, K>(kernel, PhantomData)) },
            Set::Portable => kernel.run::<[f64; LANES]>(),
        }
    }

    /// Computes with vectors of a single register, for kernels that hold many vectors at a time.
    pub fn compute_by_register<K: Kernel>(self, kernel: K) -> K::Output {
        match self.0 {
            // Safety: as above.
            #[cfg(target_arch = "x86_64")]
            Set::Avx512 => unsafe { avx512(With::<Avx512Single, K>(kernel, PhantomData)) },
            #[cfg(target_arch = "x86_64")]
            Set::Avx2 => unsafe { avx2(With::<Avx2Single, K>(kernel, PhantomData)) },
            Set::Portable => kernel.run::<[f64; PLAIN]>(),
        }
    }

    /// The kernel on one lane.
    pub fn compute_alone<K: Kernel>(self, kernel: K) -> K::Output {
        self.perform_alone(With::<[f64; 1], K>(kernel, PhantomData))
    }

    /// The best that this processor has, or those that were [forced](force_instructions).
    pub fn best() -> Instructions {
        static AVAILABLE: OnceLock<Vec<Instructions>> = OnceLock::new();
        let available = AVAILABLE.get_or_init(|| Instructions::available().collect());
        available.get(FORCED.load(Ordering::Relaxed)).copied().unwrap_or(Instructions::PORTABLE)
    }
}

/// Which of the available instruction sets counts as the best.
static FORCED: AtomicUsize = AtomicUsize::new(0);

/// The names of the instruction sets that this processor has, the best first.
#[doc(hidden)]
pub fn names() -> Vec<String> {
    Instructions::available().map(|set| format!("{set:?}")).collect()
}

/// From now on every kernel runs in the form of this name (`portable`, `avx2`, `avx512`), so that one machine
/// measures, and compares, several. False where the processor lacks it.
#[doc(hidden)]
pub fn force_instructions(name: &str) -> bool {
    let meant = Instructions::available().position(|set| format!("{set:?}").eq_ignore_ascii_case(name));
    if let Some(n) = meant {
        FORCED.store(n, Ordering::Relaxed);
    }
    meant.is_some()
}

/// Work that is compiled once for each instruction set. `run` and all it calls must be `inline(always)`.
pub trait Task {
    type Output;
    fn run(self) -> Self::Output;
}

/// A task that is written for vectors.
pub trait Kernel {
    type Output;
    fn run<V: Vector>(self) -> Self::Output;
}

/// A kernel with its vectors.
struct With<V, K>(K, PhantomData<V>);

impl<V: Vector, K: Kernel> Task for With<V, K> {
    type Output = K::Output;

    #[inline(always)]
    fn run(self) -> K::Output {
        self.0.run::<V>()
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx2,fma")]
fn avx512<T: Task>(task: T) -> T::Output {
    task.run()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn avx2<T: Task>(task: T) -> T::Output {
    task.run()
}
