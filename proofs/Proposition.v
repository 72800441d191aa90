(** * The Proposition of the paper: resonant steps lie on two-parameter curves

    Eq. (9):   h2/h1 = p/q in lowest terms and q h2 = m T for an integer m  (T = T_half(h1) > 0).
    Eq. (10):  h2 = b T h1 / (h1 - a T) = (p/q) h1 for integers a, b, p, q  (no zero denominator).

    The paper takes any Bezout pair a p + b q = m; with p = 1 it may have b = 0, and then (10) reads 0/0.
    Pairs are not unique, (a + q k, b - p k), and b <> 0 closes the gap.

    - [gap]                what b = 0 would do to (10): its denominator vanishes;
    - [bezout_nonzero]     a p + b q = m has a solution with b <> 0;
    - [forward], [backward]
                           both directions for given p/q in lowest terms, with m = a p + b q;
    - [proposition]        (9) iff (10);
    - [symmetric_form]     (10) says 1/T = a/h1 + b/h2;
    - [resonant_steps]     a fixed h1 with T/h1 = p/m: every q coprime to p gives a resonant h2;
    - [sign_of_b]          for T > h1 (that is th < pi): a <= 0 gives b > 0, a >= 1 gives b < 0.       *)

From Coq Require Import Reals ZArith Lia Lra Psatz Znumtheory.
Open Scope R_scope.

Definition resonant_with (p q m : Z) (h1 h2 T : R) :=
  (0 < p)%Z /\ (0 < q)%Z /\ Z.gcd p q = 1%Z /\ h2 / h1 = IZR p / IZR q /\ IZR q * h2 = IZR m * T.

Definition resonant (h1 h2 T : R) := exists p q m, resonant_with p q m h1 h2 T.          (* eq. (9) *)

Definition on_curve_with (a b p q : Z) (h1 h2 T : R) :=
  q <> 0%Z /\ h1 - IZR a * T <> 0 /\
  h2 = IZR b * T * h1 / (h1 - IZR a * T) /\ h2 = IZR p / IZR q * h1.

Definition on_curve (h1 h2 T : R) := exists a b p q, on_curve_with a b p q h1 h2 T.       (* eq. (10) *)

Section Proposition.
Variables (h1 h2 T : R).
Hypotheses (h1_pos : 0 < h1) (h2_pos : 0 < h2) (T_pos : 0 < T).

Lemma IZR_pos z : (0 < z)%Z -> 0 < IZR z.
Proof. intros; now apply IZR_lt. Qed.

Lemma ratio p q : (0 < q)%Z -> h2 / h1 = IZR p / IZR q <-> IZR q * h2 = IZR p * h1.
Proof.
  intros Q; apply IZR_pos in Q; split; intros E.
  - replace h2 with (h2 / h1 * h1) by (field; lra); rewrite E; field; lra.
  - apply Rmult_eq_reg_l with (IZR q * h1); [|nra].
    transitivity (IZR q * h2); [field; lra | rewrite E; field; lra].
Qed.

(** The paper's choice may have b = 0; then h1 = a T exactly. *)
Theorem gap p q m a :
  resonant_with p q m h1 h2 T -> m = (a * p + 0 * q)%Z -> h1 - IZR a * T = 0.
Proof.
  intros (P & Q & _ & R & M) ->; apply ratio in R; [|assumption].
  apply IZR_pos in P; rewrite plus_IZR, !mult_IZR in M.
  apply Rmult_eq_reg_l with (IZR p); nra.
Qed.

Lemma bezout_nonzero p q m :
  (0 < p)%Z -> (0 < q)%Z -> Z.gcd p q = 1%Z -> exists a b, (a * p + b * q = m /\ b <> 0)%Z.
Proof.
  intros P Q G; destruct (Zis_gcd_bezout p q 1) as [a b E]; [rewrite <- G; apply Zgcd_is_gcd|].
  destruct (Z.eq_dec (b * m) 0) as [Z|N].
  - exists (a * m + q)%Z, (b * m - p)%Z; split; [|lia].
    transitivity ((a * p + b * q) * m)%Z; [ring | rewrite E; ring].
  - exists (a * m)%Z, (b * m)%Z; split; [|exact N].
    transitivity ((a * p + b * q) * m)%Z; [ring | rewrite E; ring].
Qed.

Theorem forward p q m :
  resonant_with p q m h1 h2 T ->
  exists a b, m = (a * p + b * q)%Z /\ b <> 0%Z /\ on_curve_with a b p q h1 h2 T.
Proof.
  intros (P & Q & G & R & M); apply ratio in R; [|assumption].
  destruct (bezout_nonzero p q m P Q G) as (a & b & <- & B).
  exists a, b; split; [reflexivity|]; split; [exact B|].
  apply IZR_pos in P; pose proof (IZR_pos q Q) as Q'; rewrite plus_IZR, !mult_IZR in M.
  assert (B' : IZR b <> 0) by (intros E; apply eq_IZR in E; contradiction).
  assert (D : IZR p * (h1 - IZR a * T) = IZR b * IZR q * T) by nra.
  assert (N : h1 - IZR a * T <> 0).
  { intros E; rewrite E, Rmult_0_r in D; symmetry in D.
    apply Rmult_integral in D as [D|D]; [apply Rmult_integral in D as [D|D]; [contradiction | lra] | lra]. }
  split; [lia|]; split; [exact N|]; split.
  - apply Rmult_eq_reg_r with (IZR p * (h1 - IZR a * T)); [|apply Rmult_integral_contrapositive; split; [lra | exact N]].
    transitivity (IZR b * T * (IZR p * h1)); [rewrite D, <- R; ring | field; exact N].
  - apply Rmult_eq_reg_l with (IZR q); [|lra]; rewrite R; field; lra.
Qed.

Theorem backward a b p q :
  (0 < p)%Z -> (0 < q)%Z -> Z.gcd p q = 1%Z ->
  on_curve_with a b p q h1 h2 T -> resonant_with p q (a * p + b * q) h1 h2 T.
Proof.
  intros P Q G (_ & N & C & R); pose proof (IZR_pos p P); pose proof (IZR_pos q Q).
  assert (E : IZR q * h2 = IZR p * h1) by (rewrite R; field; lra).
  split; [exact P|]; split; [exact Q|]; split; [exact G|]; split; [now apply ratio|].
  rewrite plus_IZR, !mult_IZR.
  assert (D : h2 * (h1 - IZR a * T) = IZR b * T * h1) by (rewrite C at 1; field; exact N).
  apply Rmult_eq_reg_r with h1; [|lra].
  transitivity (IZR a * (IZR p * h1) * T + IZR q * (IZR b * T * h1)); [rewrite <- D, <- E; ring | ring].
Qed.

Lemma lowest p q :
  q <> 0%Z -> h2 = IZR p / IZR q * h1 ->
  exists p' q', (0 < p' /\ 0 < q' /\ Z.gcd p' q' = 1)%Z /\ h2 = IZR p' / IZR q' * h1.
Proof.
  assert (Pos : forall p q, (0 < q)%Z -> h2 = IZR p / IZR q * h1 ->
    exists p' q', (0 < p' /\ 0 < q' /\ Z.gcd p' q' = 1)%Z /\ h2 = IZR p' / IZR q' * h1).
  { clear p q; intros p q Q E; pose proof (IZR_pos q Q) as Q'.
    assert (P : (0 < p)%Z).
    { apply lt_IZR; apply Rmult_lt_reg_r with (h1 / IZR q); [apply Rdiv_lt_0_compat; lra|].
      rewrite Rmult_0_l; replace (IZR p * (h1 / IZR q)) with h2 by (rewrite E; field; lra); exact h2_pos. }
    pose proof (Z.gcd_nonneg p q) as G0; set (g := Z.gcd p q) in *.
    assert (G1 : g <> 0%Z) by (intros Z; apply Z.gcd_eq_0_r in Z; lia).
    destruct (Z.gcd_divide_l p q) as [p' Ep]; destruct (Z.gcd_divide_r p q) as [q' Eq]; fold g in Ep, Eq.
    exists p', q'; split; [split; [nia | split; [nia|]]|].
    - pose proof (Z.gcd_div_gcd p q g G1 eq_refl) as D.
      rewrite Ep, Eq, !Z.div_mul in D by assumption; exact D.
    - assert (0 < IZR g) by (apply IZR_pos; lia).
      assert (0 < IZR q') by (apply IZR_pos; nia).
      rewrite E, Ep, Eq, !mult_IZR; field; lra. }
  intros Q E; destruct (Z_lt_le_dec 0 q) as [L|L]; [now apply (Pos p q)|].
  apply (Pos (- p)%Z (- q)%Z); [lia|].
  assert (IZR q <> 0) by (intros Z; apply eq_IZR in Z; contradiction).
  rewrite E, !opp_IZR; field; assumption.
Qed.

Theorem proposition : resonant h1 h2 T <-> on_curve h1 h2 T.
Proof.
  split.
  - intros (p & q & m & R); destruct (forward p q m R) as (a & b & _ & _ & C); now exists a, b, p, q.
  - intros (a & b & p & q & Q & N & C & R).
    destruct (lowest p q Q R) as (p' & q' & (P' & Q' & G') & R').
    exists p', q', (a * p' + b * q')%Z; apply backward; try assumption.
    split; [lia | now split].
Qed.

Theorem symmetric_form a b :
  h1 - IZR a * T <> 0 -> h2 = IZR b * T * h1 / (h1 - IZR a * T) <-> 1 / T = IZR a / h1 + IZR b / h2.
Proof.
  intros N; split; intros E.
  - assert (D : h2 * (h1 - IZR a * T) = IZR b * T * h1) by (rewrite E at 1; field; exact N).
    apply Rmult_eq_reg_r with (T * h1 * h2); [|apply Rgt_not_eq; repeat apply Rmult_lt_0_compat; assumption].
    transitivity (h1 * h2); [field; lra|].
    transitivity (IZR a * T * h2 + IZR b * T * h1); [rewrite <- D; ring | field; lra].
  - apply Rmult_eq_reg_r with (h1 - IZR a * T); [|exact N].
    transitivity (IZR b * T * h1); [|field; exact N].
    assert (D : h1 * h2 = IZR a * T * h2 + IZR b * T * h1).
    { transitivity (1 / T * (T * h1 * h2)); [field; lra | rewrite E; field; lra]. }
    lra.
Qed.

(** A fixed h1 with T/h1 = p/m: every q coprime to p gives a resonant slow step. *)
Theorem resonant_steps p q m :
  (0 < p)%Z -> (0 < q)%Z -> Z.gcd p q = 1%Z -> IZR m * T = IZR p * h1 ->
  resonant_with p q m h1 (IZR p / IZR q * h1) T.
Proof.
  intros P Q G E; apply IZR_pos in Q as Q'.
  split; [exact P|]; split; [exact Q|]; split; [exact G|]; split; [field | rewrite E; field]; lra.
Qed.

(** th / pi = h1 / T < 1, the range of an oscillator below its own Verlet limit. *)
Theorem sign_of_b a b :
  h1 < T -> 1 / T = IZR a / h1 + IZR b / h2 -> ((a <= 0 -> 0 < b) /\ (1 <= a -> b < 0))%Z.
Proof.
  intros L E.
  assert (D : h1 * h2 = IZR a * T * h2 + IZR b * T * h1).
  { transitivity (1 / T * (T * h1 * h2)); [field; lra | rewrite E; field; lra]. }
  assert (0 < T * h1) by nra; assert (0 < T * h2) by nra; assert (0 < h1 * h2) by nra.
  split; intros A; apply lt_IZR; apply IZR_le in A.
  - assert (0 < IZR b * (T * h1)) by nra; nra.
  - assert (T * h2 <= IZR a * (T * h2)) by nra.
    assert (h1 * h2 < T * h2) by nra.
    assert (IZR b * (T * h1) < 0) by nra; nra.
Qed.
End Proposition.
