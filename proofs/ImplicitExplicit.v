(** * The fast force by the implicit midpoint rule, the slow one by kicks

    Over a step h the slow force L2 kicks half, the midpoint rule for the fast force L1 takes the whole step, the slow force kicks half:

        [[1, 0], [-h L2/2, 1]]  1/(1 + q) [[1 - q, h], [-h L1, 1 - q]]  [[1, 0], [-h L2/2, 1]],       q = h^2 L1/4.

    - [implicit_explicit]  for L1 >= 0 the step is elliptic iff h^2 L2 < 4 and L1 + L2 > 0, whatever L1: no resonance at all;
    - [implicit_explicit_beyond]  for 4 < h^2 L2 it grows exponentially.                                        *)

From Kickdrift Require Import Vocabulary Algebra Stability.
From Coq Require Import Reals Lra Psatz.
Open Scope R_scope.

Definition midpoint (h L : R) :=
  let q := h * h * L / 4 in
  Mat ((1 - q) / (1 + q)) (h / (1 + q)) (- (h * L) / (1 + q)) ((1 - q) / (1 + q)).

Definition implicit_explicit_step (h L1 L2 : R) := kick (h * L2 / 2) ** midpoint h L1 ** kick (h * L2 / 2).

Section Step.
Variables h L1 L2 : R.
Hypotheses (h_pos : 0 < h) (L1_pos : 0 <= L1).
Let q := h * h * L1 / 4.

Lemma q_pos : 0 < 1 + q.
Proof. unfold q; nra. Qed.

Lemma det_step : det (implicit_explicit_step h L1 L2) = 1.
Proof.
  pose proof q_pos as Q; unfold implicit_explicit_step, midpoint, det; simpl; fold q.
  replace (h * L1) with (4 * q / h) by (unfold q; field; lra); field; lra.
Qed.

Lemma trace_step : tr (implicit_explicit_step h L1 L2) = (2 * (1 - q) - h * h * L2) / (1 + q).
Proof. pose proof q_pos; unfold implicit_explicit_step, midpoint, tr; simpl; fold q; field; lra. Qed.

Theorem elliptic_iff : -2 < tr (implicit_explicit_step h L1 L2) < 2 <-> h * h * L2 < 4 /\ 0 < L1 + L2.
Proof.
  pose proof q_pos as Q; rewrite trace_step; set (t := 2 * (1 - q) - h * h * L2).
  assert (E : t / (1 + q) * (1 + q) = t) by (field; lra).
  assert (H : 0 < h * h) by nra.
  split; intros [A B].
  - assert (- (2 * (1 + q)) < t < 2 * (1 + q)) as [C D] by (split; nra).
    unfold t in C, D; split; [lra|].
    apply Rmult_lt_reg_l with (h * h); [assumption|]; unfold q in D; lra.
  - assert (- (2 * (1 + q)) < t < 2 * (1 + q)) as [C D].
    { unfold t; split; [lra|]; pose proof (Rmult_lt_0_compat _ _ H B); unfold q; lra. }
    split; apply Rmult_lt_reg_r with (1 + q); rewrite ?E; lra.
Qed.

Theorem implicit_explicit : h * h * L2 < 4 -> 0 < L1 + L2 -> bounded_powers (implicit_explicit_step h L1 L2).
Proof. intros A B; apply elliptic; [exact det_step | now apply elliptic_iff]. Qed.

(** Beyond it the step grows exponentially, whatever L1. *)
Theorem implicit_explicit_beyond : 4 < h * h * L2 -> exponential_growth (implicit_explicit_step h L1 L2).
Proof.
  intros A; pose proof q_pos as Q; apply hyperbolic; [exact det_step|].
  rewrite trace_step; set (t := 2 * (1 - q) - h * h * L2).
  assert (t / (1 + q) < -2).
  { apply Rmult_lt_reg_r with (1 + q); [lra|]; replace (t / (1 + q) * (1 + q)) with t by (field; lra); unfold t; lra. }
  unfold Rabs; destruct Rcase_abs; lra.
Qed.
End Step.
