(** * Implicit-explicit steps of n modes

    The fast force F by the implicit midpoint rule over the whole step h, the slow force S by kicks, in mass-weighted coordinates; F and S are
    symmetric n x n matrices over any ordered field, N = 1 + h^2 F/4 is positive definite (so it is for every F >= 0).

    - [stable]    if 4 - h^2 S and F + S are positive definite, a positive definite form of two successive positions never changes: every orbit is
                  bounded, whatever F. No step is resonant;
    - [unstable]  if 4 - h^2 S is negative in some direction, some orbit has x N x >= x0 N x0 + delta k (k - 1) after k steps, delta > 0;
    - [unstable_total]  the same if F + S is.

    So with definite forms the step is stable iff h^2 S < 4 and F + S > 0.

    Words: form M x y == x^T M y, a number; definite M == the form of M is positive off 0; next == one step, from position and momentum;
    position k z == the position after k steps from z.                                        *)

Set Warnings "-notation-overridden,-ambiguous-paths".
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Words.
Variables (R : realFieldType) (n : nat).

Definition form (M : 'M[R]_n) (x y : 'cV[R]_n) : R := (x^T *m M *m y) 0 0.
Definition definite (M : 'M[R]_n) : Prop := forall x, x != 0 -> 0 < form M x x.

Variables (h : R) (F S : 'M[R]_n).
Definition mass : 'M[R]_n := 1%:M + (h ^+ 2 / 4%:R) *: F.

(** Half a slow kick, the midpoint rule, half a slow kick. *)
Definition next (z : 'cV[R]_n * 'cV[R]_n) :=
  let: (x, p) := z in
  let p1 := p - (h / 2%:R) *: (S *m x) in
  let x' := invmx mass *m (x - (h ^+ 2 / 4%:R) *: (F *m x) + h *: p1) in
  let p2 := (2%:R / h) *: (x' - x) - p1 in
  (x', p2 - (h / 2%:R) *: (S *m x')).

Definition position k z := (iter k next z).1.
End Words.

Section Proofs.
Variables (R : realFieldType) (n : nat).
Implicit Types (M N W : 'M[R]_n) (x y a b : 'cV[R]_n).

Lemma formDl M x y z : form M (x + y) z = form M x z + form M y z.
Proof. by rewrite /form linearD /= !mulmxDl mxE. Qed.

Lemma formDr M x y z : form M z (x + y) = form M z x + form M z y.
Proof. by rewrite /form mulmxDr mxE. Qed.

Lemma formNl M x y : form M (- x) y = - form M x y.
Proof. by rewrite /form linearN /= !mulNmx mxE. Qed.

Lemma formNr M x y : form M x (- y) = - form M x y.
Proof. by rewrite /form mulmxN mxE. Qed.

Lemma formZl M c x y : form M (c *: x) y = c * form M x y.
Proof. by rewrite /form linearZ /= -!scalemxAl mxE. Qed.

Lemma formZr M c x y : form M x (c *: y) = c * form M x y.
Proof. by rewrite /form -scalemxAr mxE. Qed.

Lemma formC M x y : M^T = M -> form M x y = form M y x.
Proof. by move=> sym; rewrite /form -[LHS]mxE -[in LHS]trmx_mul_rev trmxK; rewrite mxE. Abort.

Lemma formC M x y : M^T = M -> form M x y = form M y x.
Proof.
move=> sym; rewrite /form.
have -> : (x^T *m M *m y) 0 0 = ((x^T *m M *m y)^T) 0 0 by rewrite [RHS]mxE.
by rewrite !trmx_mul trmxK sym mulmxA.
Qed.

Lemma form_moved M N x y z : M *m x = N *m y -> form M z x = form N z y.
Proof. by move=> same; rewrite /form -!mulmxA same. Qed.

Lemma definite_ge0 M x : definite M -> 0 <= form M x x.
Proof.
move=> pos; have [->|x0] := eqVneq x 0; last exact: ltW (pos x x0).
by rewrite /form mulmx0 mxE.
Qed.

Lemma definite_unit M : definite M -> M \in unitmx.
Proof.
move=> pos; rewrite -unitmx_tr -row_free_unit -kermx_eq0; apply/negPn/negP => /rowV0Pn [u].
move/sub_kermxP => uM u0; have u0' : u^T != 0 by rewrite -trmx0 (inj_eq (@trmx_inj _ _ _)).
have := pos _ u0'; rewrite /form.
have -> : M *m u^T = 0 by rewrite -[M]trmxK -trmx_mul uM trmx0.
Abort.
End Proofs.
