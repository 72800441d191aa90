(** * Vocabulary: what the theorems speak about, and nothing else

    vec, mat          == a state (position, velocity)^T; a real 2 x 2 matrix [[A, B], [C, D]]
    M ** N, power M n == matrix product (N acts first), n-th power
    M @ u             == matrix times vector
    det, tr, mirror   == determinant; trace; time reversal, [[A, B], [C, D]] |-> [[D, B], [C, A]]
    kick k, drift t   == [[1, 0], [-k, 1]] and [[1, t], [0, 1]]
    step, propagator  == one kick or drift; the product over a schedule (list of steps, first step first)
    schedule f d n    == n ticks of length d, kicks f 0 ... f n, with HALF a kick at either end
    staggered f d n   == the same ticks as the event loop runs them: kick, drift, kick, drift ...
    strikes m late j  == a clock whose step is 2m ticks kicks at tick j (late: phase 1/2)
    two_clocks        == the kicks of the fast clock (step 2q ticks) and the slow one (2p ticks)
    many_clocks       == the kicks of any list of clocks
    tick, half_period, full_period
                      == the tick h1/(2q), and the propagators over T/2 and T of two clocks with p h1 = q h2
    three_term t a b  == the sequence X_0 = a, X_1 = b, X_{n+2} = t X_{n+1} - X_n
    norm, bounded_powers, exponential_growth, linear_growth
                      == sum of absolute entries, and the three ways in which powers can behave
    kind, row, behaves
                      == the seven verdicts; their row in the four-sign table; what they promise
    verdict k p q h1 L1 h2 L2
                      == two clocks with h2/h1 = p/q in lowest terms behave as k says               *)

From Coq Require Import Reals List Arith Bool.
Import ListNotations.
Open Scope R_scope.

(** ** States and matrices *)

Record vec := Vec { position : R; velocity : R }.
Record mat := Mat { mA : R; mB : R; mC : R; mD : R }.

Definition one := Mat 1 0 0 1.
Definition opp (M : mat) := Mat (- mA M) (- mB M) (- mC M) (- mD M).

Definition mul (M N : mat) :=
  Mat (mA M * mA N + mB M * mC N) (mA M * mB N + mB M * mD N)
      (mC M * mA N + mD M * mC N) (mC M * mB N + mD M * mD N).
Infix "**" := mul (at level 40, left associativity).

Definition act (M : mat) (u : vec) :=
  Vec (mA M * position u + mB M * velocity u) (mC M * position u + mD M * velocity u).
Infix "@" := act (at level 35, right associativity).

Fixpoint power (M : mat) (n : nat) : mat :=
  match n with O => one | S n' => M ** power M n' end.

Definition det (M : mat) := mA M * mD M - mB M * mC M.
Definition tr (M : mat) := mA M + mD M.
Definition mirror (M : mat) := Mat (mD M) (mB M) (mC M) (mA M).

(** ** Kicks, drifts, schedules *)

Definition kick (k : R) := Mat 1 0 (- k) 1.
Definition drift (t : R) := Mat 1 t 0 1.

Inductive step := Kick (k : R) | Drift (t : R).
Definition matrix_of (e : step) := match e with Kick k => kick k | Drift t => drift t end.

Fixpoint propagator (steps : list step) : mat :=
  match steps with [] => one | e :: rest => propagator rest ** matrix_of e end.

Definition leg (f : nat -> R) (d : R) (i : nat) := [Kick (f i / 2); Drift d; Kick (f (S i) / 2)].
Definition schedule (f : nat -> R) (d : R) (n : nat) := flat_map (leg f d) (seq 0 n).
Definition staggered (f : nat -> R) (d : R) (n : nat) :=
  flat_map (fun i => [Kick (f i); Drift d]) (seq 0 n).

(** ** Two clocks over the synchronization period T = p h1 = q h2, cut into 2 p q ticks *)

Definition strikes (m : nat) (late : bool) (j : nat) : bool :=
  (j + (if late then m else 0)) mod (2 * m) =? 0.

Definition two_clocks (p q : nat) (late1 late2 : bool) (k1 k2 : R) (j : nat) : R :=
  (if strikes q late1 j then k1 else 0) + (if strikes p late2 j then k2 else 0).

(** Any number of clocks (m, late, k): steps of 2m ticks, phase 0 or 1/2, strength k. *)
Definition many_clocks (clocks : list (nat * bool * R)) (j : nat) : R :=
  fold_right (fun '(m, late, k) sum => (if strikes m late j then k else 0) + sum) 0 clocks.

Definition tick (q : nat) (h1 : R) := h1 / (2 * INR q).

(** Both clocks start at t = 0; clock i has step h_i and stiffness L_i, so it kicks with h_i L_i. *)
Definition half_period (p q : nat) (h1 L1 h2 L2 : R) :=
  propagator (schedule (two_clocks p q false false (h1 * L1) (h2 * L2)) (tick q h1) (p * q)).
Definition full_period (p q : nat) (h1 L1 h2 L2 : R) :=
  propagator (schedule (two_clocks p q false false (h1 * L1) (h2 * L2)) (tick q h1) (2 * (p * q))).

(** ** Three-term recurrences: the Chebyshev polynomials without trigonometry *)

Fixpoint three_term (t a b : R) (n : nat) : R :=
  match n with O => a | S n' => three_term t b (t * b - a) n' end.

(** ** How powers behave *)

Definition norm (M : mat) := Rabs (mA M) + Rabs (mB M) + Rabs (mC M) + Rabs (mD M).

Definition bounded_powers (Q : mat) := exists K, forall n, norm (power Q n) <= K.

(** The multiplier: the eigenvalue of largest modulus, up to sign, when |Tr| >= 2. *)
Definition multiplier (Q : mat) := (Rabs (tr Q) + sqrt (tr Q * tr Q - 4)) / 2.

Definition exponential_growth (Q : mat) :=
  let mu := multiplier Q in
  1 < mu /\ exists K, forall n, mu ^ n <= norm (power Q n) <= K * mu ^ n.

Definition linear_growth (Q : mat) :=
  exists c K, 0 < c /\ forall n, c * INR n <= norm (power Q n) <= 2 + K * INR n.

(** ** The seven verdicts *)

Inductive side := Plus | Minus.                     (* Tr >= 2, Tr <= -2 *)
Inductive kind := Elliptic | Hyperbolic (s : side) | Parabolic (s : side) | Coexistence (s : side).

(** The row of the four-sign table, read off the half period H = [[A, B], [C, D]]. *)
Definition row (k : kind) (H : mat) : Prop :=
  match k with
  | Elliptic          => mB H * mC H < 0 < mA H * mD H
  | Hyperbolic Plus   => 0 < mB H * mC H
  | Hyperbolic Minus  => mA H * mD H < 0
  | Parabolic Plus    => (mB H = 0 /\ mC H <> 0) \/ (mB H <> 0 /\ mC H = 0)
  | Parabolic Minus   => (mA H = 0 /\ mD H <> 0) \/ (mA H <> 0 /\ mD H = 0)
  | Coexistence Plus  => mB H = 0 /\ mC H = 0
  | Coexistence Minus => mA H = 0 /\ mD H = 0
  end.

(** What the verdict promises of the full period Q. *)
Definition behaves (k : kind) (Q : mat) : Prop :=
  match k with
  | Elliptic          => -2 < tr Q < 2 /\ bounded_powers Q
  | Hyperbolic Plus   => 2 < tr Q /\ exponential_growth Q
  | Hyperbolic Minus  => tr Q < -2 /\ exponential_growth Q
  | Parabolic Plus    => tr Q = 2 /\ linear_growth Q
  | Parabolic Minus   => tr Q = -2 /\ linear_growth Q
  | Coexistence Plus  => Q = one /\ bounded_powers Q
  | Coexistence Minus => Q = opp one /\ bounded_powers Q
  end.

(** The verdict on two clocks whose steps have the ratio h2/h1 = p/q in lowest terms. *)
Record verdict (k : kind) (p q : nat) (h1 L1 h2 L2 : R) : Prop := {
  lowest_terms : (1 <= p /\ 1 <= q /\ Nat.gcd p q = 1)%nat;
  steps        : 0 < h1 /\ 0 < h2 /\ INR p * h1 = INR q * h2;
  behaviour    : behaves k (full_period p q h1 L1 h2 L2)
}.
